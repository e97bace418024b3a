//! From bytes to a table of text and numbers: separators, encodings, broken rows.

use std::collections::HashSet;
use std::io::{BufRead, BufReader, Read};

use super::records::{Fingerprinted, Records, stream};
use super::table::TextTable;
use crate::error::{Error, Result, codes};

/// Fewest rows of data that a recording may have; below it no filter and no split makes sense.
pub const MINIMUM_ROWS: usize = 20;

/// Bytes at the start of the file from which the separator is told.
const HEADER_PROBE_BYTES: usize = 1 << 16;

/// A table that has been read but not yet interpreted.
pub(super) struct RawTable {
    pub(super) table: TextTable,
    pub(super) fingerprint: u64,
    pub(super) decimal_comma: bool,
}

/// Reads header and rows; every row has as many fields as the header.
pub(super) fn read(mut source: impl Read) -> Result<RawTable> {
    let mut probe = Vec::with_capacity(HEADER_PROBE_BYTES);
    source.by_ref().take(HEADER_PROBE_BYTES as u64).read_to_end(&mut probe).map_err(|error| stream(&error))?;
    let separator = separator_of(&probe);
    let source = BufReader::new(Fingerprinted::new(Read::chain(&probe[..], source)));
    let mut records = Records::new(source, separator);
    if !records.advance()? {
        return Err(Error::new(&codes::EMPTY_FILE, "the file holds no header and no data"));
    }
    let mut table = TextTable::new(read_header(&records)?);
    while records.advance()? {
        push_row(&mut table, &records)?;
    }
    if table.len() < MINIMUM_ROWS {
        let message = format!("a recording needs at least {MINIMUM_ROWS} rows of data");
        let last = table.len().checked_sub(1).map_or(1, |index| table.line(index));
        return Err(Error::new(&codes::TOO_FEW_ROWS, message).at_row(last).with_value(table.len().to_string()));
    }
    let fingerprint = records.source().get_ref().fingerprint();
    Ok(RawTable { table, fingerprint, decimal_comma: separator != b',' })
}

impl RawTable {
    /// Reads a field as a finite number.
    pub(super) fn number(&self, field: &str, row: usize, column: &str) -> Result<f64> {
        let here = |code, message: &str| {
            Error::new(code, message).at_row(self.table.line(row)).in_column(column).with_value(field)
        };
        let parsed = match field.parse::<f64>() {
            Err(_) if self.decimal_comma && !field.contains('.') => field.replacen(',', ".", 1).parse(),
            other => other,
        };
        match parsed {
            Ok(number) if number.is_finite() => Ok(number),
            Ok(_) => Err(here(&codes::NOT_FINITE, "this value is not finite")),
            Err(_) if field.is_empty() => Err(here(&codes::NOT_A_NUMBER, "this field is empty")),
            Err(_) => Err(here(&codes::NOT_A_NUMBER, "this is not a number")),
        }
    }
}

/// The most frequent of comma, semicolon and tab on the first line that is no comment.
fn separator_of(probe: &[u8]) -> u8 {
    let header = probe
        .split(|byte| matches!(byte, b'\n' | b'\r'))
        .find(|line| !line.is_empty() && line[0] != b'#')
        .unwrap_or_default();
    let count = |separator: u8| header.iter().filter(|byte| **byte == separator).count();
    // On a tie the comma wins, being the last of the candidates with the largest count.
    [b'\t', b';', b','].into_iter().max_by_key(|separator| count(*separator)).unwrap_or(b',')
}

fn read_header(records: &Records<impl BufRead>) -> Result<Vec<String>> {
    let mut header: Vec<String> = Vec::with_capacity(records.len());
    let mut seen = HashSet::with_capacity(records.len());
    for (index, field) in records.fields().enumerate() {
        let name = utf8(field, 1, &format!("column {}", index + 1))?;
        if !name.is_empty() && !seen.insert(name) {
            return Err(Error::new(&codes::DUPLICATE_COLUMN, "two columns have this name").at_row(1).in_column(name));
        }
        header.push(name.to_owned());
    }
    if header.iter().all(|name| name.parse::<f64>().is_ok()) {
        let message = "the first row holds numbers only: the header with the names of the columns is missing";
        return Err(Error::new(&codes::NO_KNOWN_COLUMN, message).at_row(1).with_value(header.join(",")));
    }
    Ok(header)
}

fn push_row(table: &mut TextTable, records: &Records<impl BufRead>) -> Result<()> {
    let expected = table.header().len();
    if records.len() != expected {
        let message = format!("this row has {} fields, the header has {expected}", records.len());
        let text = String::from_utf8_lossy(&records.fields().collect::<Vec<_>>().concat()).into_owned();
        return Err(Error::new(&codes::RAGGED_ROW, message).at_row(records.line()).with_value(text));
    }
    table.begin_row(records.line());
    for (index, field) in records.fields().enumerate() {
        let text = std::str::from_utf8(field).map_err(|_| not_utf8(field, records.line(), &table.header()[index]))?;
        table.push_field(text);
    }
    Ok(())
}

fn utf8<'a>(field: &'a [u8], line: u64, column: &str) -> Result<&'a str> {
    std::str::from_utf8(field).map_err(|_| not_utf8(field, line, column))
}

fn not_utf8(field: &[u8], line: u64, column: &str) -> Error {
    Error::new(&codes::NOT_UTF8, "this field is not UTF-8 text")
        .at_row(line)
        .in_column(column)
        .with_value(String::from_utf8_lossy(field))
}
