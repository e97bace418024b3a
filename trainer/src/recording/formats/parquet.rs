//! Apache Parquet, datasets of LeRobot among it: columns of numbers, texts, and lists of them.

use bytes::Bytes;
use parquet::column::page::Page;
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row};

use super::{MOST_CELLS, WHOLE_LIMIT_BYTES, damaged};
use crate::error::{Error, Result, codes};
use crate::recording::table::{RawTable, TableBuilder};

/// Rows from which the lengths of lists are told.
const SAMPLE_ROWS: usize = 200;

/// Reads every row.
pub(super) fn read(bytes: &[u8]) -> Result<RawTable> {
    if !bytes.ends_with(b"PAR1") || bytes.len() < 12 {
        let message = "the file ends before its footer, without which nothing of it can be read";
        return Err(Error::new(&codes::CUT_SHORT, message));
    }
    let reader = SerializedFileReader::new(Bytes::copy_from_slice(bytes)).map_err(damaged)?;
    let metadata = reader.metadata();
    let expanded: i128 = metadata.row_groups().iter().map(|group| i128::from(group.total_byte_size())).sum();
    if expanded > i128::from(WHOLE_LIMIT_BYTES) {
        let message =
            format!("its columns have more than {WHOLE_LIMIT_BYTES} bytes when decompressed; write fewer rows a file");
        return Err(Error::new(&codes::FILE_TOO_LARGE, message).with_value(expanded.to_string()));
    }
    let rows: i128 = metadata.row_groups().iter().map(|group| i128::from(group.num_rows())).sum();
    let columns = metadata.file_metadata().schema_descr().num_columns();
    if rows.saturating_mul(columns as i128) > MOST_CELLS as i128 {
        let message = format!("it has more than {MOST_CELLS} cells; write fewer rows a file");
        return Err(Error::new(&codes::FILE_TOO_LARGE, message).with_value(rows.to_string()));
    }
    refuse_overlong_pages(&reader).map_err(damaged)?;
    let rows = reader.get_row_iter(None).map_err(damaged)?;
    let mut first: Vec<Vec<String>> = Vec::new();
    let mut builder: Option<TableBuilder> = None;
    let mut header: Vec<String> = Vec::new();
    for (index, row) in rows.enumerate() {
        let row = row.map_err(|error| damaged(error).at_row(index as u64 + 1))?;
        if index == 0 {
            header = row.get_column_iter().map(|(name, _)| name.clone()).collect();
        }
        let cells = cells(&row);
        match &mut builder {
            Some(builder) => builder.push(index as u64 + 1, cells.iter().map(String::as_str))?,
            None => first.push(cells),
        }
        if first.len() == SAMPLE_ROWS {
            builder = Some(begin(&header, &first)?);
            first.clear();
        }
    }
    let builder = builder.map_or_else(|| begin(&header, &first), Ok)?;
    Ok(builder.finish())
}

/// Refuses pages that claim more values than they or their columns can hold: the library asks for memory by these numbers.
fn refuse_overlong_pages(reader: &SerializedFileReader<Bytes>) -> Result<(), ParquetError> {
    let overlong = || Err(ParquetError::General("a page claims more values than there are".to_owned()));
    for index in 0..reader.num_row_groups() {
        let group = reader.get_row_group(index)?;
        for column in 0..group.num_columns() {
            let values = group.metadata().column(column).num_values();
            let mut pages = group.get_column_page_reader(column)?;
            while let Some(page) = pages.peek_next_page()? {
                if page.is_dict {
                    if let Some(Page::DictionaryPage { buf, num_values, .. }) = pages.get_next_page()?
                        && num_values as usize > buf.len()
                    {
                        return overlong();
                    }
                } else {
                    let claimed = page.num_levels.or(page.num_rows).unwrap_or(0);
                    if i64::try_from(claimed).map_or(true, |claimed| claimed > values) {
                        return overlong();
                    }
                    pages.skip_next_page()?;
                }
            }
        }
    }
    Ok(())
}

fn begin(header: &[String], first: &[Vec<String>]) -> Result<TableBuilder<'static>> {
    let sample: Vec<Vec<&str>> = first.iter().map(|row| row.iter().map(String::as_str).collect()).collect();
    let mut builder = TableBuilder::new(header.to_vec(), 1, &sample)?;
    for (index, row) in sample.into_iter().enumerate() {
        builder.push(index as u64 + 1, row.into_iter())?;
    }
    Ok(builder)
}

fn cells(row: &Row) -> Vec<String> {
    row.get_column_iter().map(|(_, field)| cell(field)).collect()
}

fn cell(field: &Field) -> String {
    match field {
        Field::Null => String::new(),
        Field::Bool(flag) => u8::from(*flag).to_string(),
        Field::Byte(value) => value.to_string(),
        Field::Short(value) => value.to_string(),
        Field::Int(value) => value.to_string(),
        Field::Long(value)
        | Field::TimestampMillis(value)
        | Field::TimestampMicros(value)
        | Field::TimeMicros(value) => value.to_string(),
        Field::TimeMillis(value) => value.to_string(),
        Field::UByte(value) => value.to_string(),
        Field::UShort(value) => value.to_string(),
        Field::UInt(value) => value.to_string(),
        Field::ULong(value) => value.to_string(),
        // The number that a single holds, to the bit.
        Field::Float(value) => f64::from(*value).to_string(),
        Field::Double(value) => value.to_string(),
        Field::Str(text) => text.clone(),
        Field::ListInternal(list) => format!("[{}]", list.elements().iter().map(cell).collect::<Vec<_>>().join(", ")),
        _ => String::new(),
    }
}
