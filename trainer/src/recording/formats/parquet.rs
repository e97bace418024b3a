//! Apache Parquet, datasets of LeRobot among it: columns of numbers, texts, and lists of them.

use bytes::Bytes;
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::{Field, Row};

use super::{WHOLE_LIMIT_BYTES, damaged};
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
