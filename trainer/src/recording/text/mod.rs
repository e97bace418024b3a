//! From the bytes of a delimited text to a table: separators, preambles, encodings, broken rows.

mod dialect;
mod records;

use std::io::{BufRead, BufReader, Read};

use super::keep::Keep;
use super::source::failed;
use super::table::{RawTable, TableBuilder};
use crate::error::{Error, Result, codes};
use dialect::{Dialect, Header, dialect_of, leading_records};
pub use records::RECORD_LIMIT_BYTES;
use records::Records;

/// Bytes at the start of the file from which its layout is told.
const PROBE_BYTES: usize = 1 << 16;

/// Reads header and rows; every row has as many fields as the header.
pub(super) fn read(mut source: impl Read, keep: Keep<'_>) -> Result<RawTable> {
    let mut probe = Vec::with_capacity(PROBE_BYTES);
    source.by_ref().take(PROBE_BYTES as u64).read_to_end(&mut probe).map_err(|error| failed(&error))?;
    let whole = probe.len() < PROBE_BYTES;
    let dialect = dialect_of(&probe, whole);
    let mut first_rows = leading_records(&probe, whole, dialect.separator);
    first_rows.drain(..dialect.leading.min(first_rows.len()));
    let mut records = Records::new(BufReader::new(Read::chain(&probe[..], source)), dialect.separator);
    let mut heading = read_heading(&dialect, &mut records)?;
    let sample: Vec<Vec<&str>> = first_rows
        .iter()
        .filter(|row| row.len() == heading.names.len())
        .map(|row| row.iter().map(String::as_str).collect())
        .collect();
    let builder = TableBuilder::new(std::mem::take(&mut heading.names), heading.line, &sample)?;
    let mut builder = builder.reading(dialect.separator != b',', keep);
    if heading.first_is_data {
        push_row(&mut builder, &records)?;
    }
    while records.advance()? {
        push_row(&mut builder, &records)?;
    }
    let units = builder.expanded(&heading.units);
    Ok(RawTable { units, ..builder.finish() })
}

struct Heading {
    names: Vec<String>,
    units: Vec<String>,
    line: u64,
    /// Whether the record that was read last is the first row.
    first_is_data: bool,
}

fn read_heading(dialect: &Dialect, records: &mut Records<impl BufRead>) -> Result<Heading> {
    let mut heading = Heading { names: Vec::new(), units: Vec::new(), line: 1, first_is_data: false };
    for index in 0..dialect.leading {
        if !records.advance()? {
            return Err(Error::new(&codes::EMPTY_FILE, "the file holds no header and no data"));
        }
        match dialect.header {
            Header::Record { index: header, .. } if header == index => {
                heading.names = texts(records)?;
                heading.line = records.line();
            }
            Header::Record { index: header, units: true } if header + 1 == index => heading.units = texts(records)?,
            _ => {}
        }
    }
    // ROS marks its header by a per cent sign.
    if let Some(rest) = heading.names.first().and_then(|name| name.strip_prefix('%')) {
        heading.names[0] = rest.trim_start().to_owned();
    }
    if dialect.leading == 0 {
        heading.first_is_data = records.advance()?;
        heading.names = match &dialect.header {
            Header::Comment(names) => names.clone(),
            _ => (0..records.len()).map(|index| format!("column[{index}]")).collect(),
        };
    }
    Ok(heading)
}

fn texts(records: &Records<impl BufRead>) -> Result<Vec<String>> {
    let text = |(index, field)| match std::str::from_utf8(field) {
        Ok(text) => Ok(text.to_owned()),
        Err(_) => Err(not_utf8(field, records.line(), &format!("column {}", index + 1))),
    };
    records.fields().enumerate().map(text).collect()
}

fn push_row(builder: &mut TableBuilder<'_>, records: &Records<impl BufRead>) -> Result<()> {
    let header = builder.file_header();
    if records.len() != header.len() {
        let message = format!("this row has {} fields, the header has {}", records.len(), header.len());
        let text = String::from_utf8_lossy(&records.fields().collect::<Vec<_>>().concat()).into_owned();
        return Err(Error::new(&codes::RAGGED_ROW, message).at_row(records.line()).with_value(text));
    }
    for (index, field) in records.fields().enumerate() {
        if std::str::from_utf8(field).is_err() {
            return Err(not_utf8(field, records.line(), &header[index]));
        }
    }
    builder.push(records.line(), records.fields().map(|field| std::str::from_utf8(field).unwrap_or_default()))
}

fn not_utf8(field: &[u8], line: u64, column: &str) -> Error {
    Error::new(&codes::NOT_UTF8, "this field is not UTF-8 text")
        .at_row(line)
        .in_column(column)
        .with_value(String::from_utf8_lossy(field))
}
