//! JSON: an object a line, a list of objects, or one object of lists.

use std::collections::BTreeMap;

use serde_json::{Deserializer, Map, Value};

use super::names::Names;
use super::{MOST_CELLS, damaged};
use crate::error::{Error, Result, codes};
use crate::recording::table::{RawTable, TableBuilder};

/// Whether what begins like this is JSON, not a text table that begins with a bracket.
pub(super) fn is_json(start: &[u8]) -> bool {
    let next = start.trim_ascii_start()[1..].trim_ascii_start().first();
    matches!(next, Some(b'"' | b'{' | b'}' | b']') | None)
}

/// Rows from which the lengths of lists are told.
const SAMPLE_ROWS: usize = 200;

/// Rows whose cells are named by the path to them.
#[derive(Default)]
struct Rows {
    names: Names,
    rows: Vec<Vec<(usize, String)>>,
}

/// Reads every value of the file: each is a row, or holds them all.
pub(super) fn read(bytes: &[u8]) -> Result<RawTable> {
    let mut rows = Rows::default();
    let mut notes = Vec::new();
    for value in Deserializer::from_slice(bytes).into_iter::<Value>() {
        match value {
            Ok(Value::Array(list)) => list.iter().for_each(|value| rows.push(value)),
            Ok(Value::Object(object)) if is_columns(&object) => rows.push_columns(&object),
            Ok(value) => rows.push(&value),
            Err(error) if error.is_eof() && !rows.rows.is_empty() => {
                notes.push("the file is cut short: its last row is lost".to_owned());
                break;
            }
            Err(error) if error.is_eof() => return Err(Error::new(&codes::CUT_SHORT, "the file ends within a value")),
            Err(error) => {
                let line = error.line() as u64;
                return Err(damaged(format!("no JSON here, {error}")).at_row(line));
            }
        }
    }
    if rows.names.in_order.len().saturating_mul(rows.rows.len()) > MOST_CELLS {
        let message = format!("its objects have more than {MOST_CELLS} cells together; every row has other keys");
        return Err(Error::new(&codes::FILE_TOO_LARGE, message));
    }
    let mut cells: Vec<&str> = Vec::new();
    let full = |row: &Vec<(usize, String)>| {
        let mut cells = vec![String::new(); rows.names.in_order.len()];
        row.iter().for_each(|(place, text)| cells[*place].clone_from(text));
        cells
    };
    let sample: Vec<Vec<String>> = rows.rows.iter().take(SAMPLE_ROWS).map(full).collect();
    let sample: Vec<Vec<&str>> = sample.iter().map(|row| row.iter().map(String::as_str).collect()).collect();
    let mut builder = TableBuilder::new(rows.names.in_order.clone(), 1, &sample)?;
    for (index, row) in rows.rows.iter().enumerate() {
        cells.clear();
        cells.resize(rows.names.in_order.len(), "");
        row.iter().for_each(|(place, text)| cells[*place] = text);
        builder.push(index as u64 + 1, cells.iter().copied())?;
    }
    Ok(RawTable { notes, ..builder.finish() })
}

/// Whether an object is a table of its own: every entry a list, one of them longer than any vector of joints.
fn is_columns(object: &Map<String, Value>) -> bool {
    let lengths = || object.values().filter_map(Value::as_array).map(Vec::len);
    lengths().count() > 0
        && lengths().max() >= Some(crate::recording::MINIMUM_ROWS)
        && object.values().any(Value::is_array)
}

impl Rows {
    fn push(&mut self, value: &Value) {
        let mut row = Vec::new();
        match value {
            Value::Array(list) => {
                for (index, value) in list.iter().enumerate() {
                    self.flatten(&format!("column[{index}]"), value, &mut row);
                }
            }
            value => self.flatten("", value, &mut row),
        }
        self.rows.push(row);
    }

    /// The lists of an object, those of the most frequent length.
    fn push_columns(&mut self, object: &Map<String, Value>) {
        let lists = || object.iter().filter_map(|(name, value)| Some((name, value.as_array()?)));
        let mut lengths: BTreeMap<usize, usize> = BTreeMap::new();
        lists().for_each(|(_, list)| *lengths.entry(list.len()).or_default() += 1);
        let most = lengths.iter().max_by_key(|(length, count)| (**count, **length));
        let length = most.map_or(0, |(length, _)| *length);
        let start = self.rows.len();
        self.rows.resize_with(start + length, Vec::new);
        for (name, list) in lists().filter(|(_, list)| list.len() == length) {
            for (index, value) in list.iter().enumerate() {
                let mut row = std::mem::take(&mut self.rows[start + index]);
                self.flatten(name, value, &mut row);
                self.rows[start + index] = row;
            }
        }
    }

    fn flatten(&mut self, name: &str, value: &Value, row: &mut Vec<(usize, String)>) {
        let text = match value {
            Value::Null => return,
            Value::Bool(flag) => u8::from(*flag).to_string(),
            Value::Number(number) => number.to_string(),
            Value::String(text) => text.clone(),
            Value::Array(list) if list.iter().any(Value::is_object) => {
                for (index, value) in list.iter().enumerate() {
                    self.flatten(&format!("{name}[{index}]"), value, row);
                }
                return;
            }
            Value::Array(_) => value.to_string(),
            Value::Object(object) => {
                for (key, value) in object {
                    let name = if name.is_empty() { key.clone() } else { format!("{name}.{key}") };
                    self.flatten(&name, value, row);
                }
                return;
            }
        };
        row.push((self.names.place(name), text));
    }
}
