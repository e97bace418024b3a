//! NumPy's `.npy` and `.npz` (numpy.lib.format, versions 1 to 3).

use std::io::{Cursor as Bytes, Read};

use zip::ZipArchive;

use super::arrays::{Array, table_of};
use super::cursor::{Cursor, Kind, Number};
use super::{WHOLE_LIMIT_BYTES, damaged};
use crate::error::{Error, Result, codes};
use crate::recording::table::RawTable;

/// A single array: the columns of a plain one are `column[0]`, `column[1]`, those of a structured one have their names.
pub(super) fn read_array(bytes: &[u8]) -> Result<RawTable> {
    let (arrays, lost) = arrays(bytes, "column")?;
    let mut table = table_of(arrays)?;
    table.notes.extend((lost > 0).then(|| format!("the file is cut short: {lost} rows are lost")));
    Ok(table)
}

/// The arrays of an archive by their names.
pub(super) fn read_archive(bytes: &[u8]) -> Result<RawTable> {
    let mut archive = ZipArchive::new(Bytes::new(bytes)).map_err(|error| damaged(format!("no archive, {error}")))?;
    let (mut found, mut read) = (Vec::new(), 0);
    for index in 0..archive.len() {
        let file = archive.by_index(index).map_err(damaged)?;
        let name = file.name().map_err(damaged)?.into_owned();
        let Some(name) = name.strip_suffix(".npy").map(str::to_owned) else { continue };
        let mut bytes = Vec::new();
        file.take(WHOLE_LIMIT_BYTES + 1 - read)
            .read_to_end(&mut bytes)
            .map_err(|error| damaged(format!("{name}, {error}")))?;
        read += bytes.len() as u64;
        if read > WHOLE_LIMIT_BYTES {
            let message = format!("the arrays have more than {WHOLE_LIMIT_BYTES} bytes together");
            return Err(Error::new(&codes::FILE_TOO_LARGE, message));
        }
        match arrays(&bytes, &name) {
            Ok((arrays, _)) => found.extend(arrays),
            // Names of joints and the like stand beside the signals.
            Err(error) if error.code() == &codes::NOT_A_NUMBER => {}
            Err(error) => return Err(error.in_column(name)),
        }
    }
    if found.is_empty() {
        let message = "an archive without arrays of NumPy; a spreadsheet has to be saved as CSV first";
        return Err(Error::new(&codes::FORMAT_NOT_READ, message));
    }
    table_of(found)
}

/// The arrays in the bytes of one `.npy`: one, or one a field of a structure; and the rows that are missing at its end.
fn arrays(bytes: &[u8], name: &str) -> Result<(Vec<Array>, usize)> {
    let cut = || Error::new(&codes::CUT_SHORT, "the header of the array is cut short");
    let mut cursor = Cursor::new(bytes, false);
    let magic = cursor.take(6).ok_or_else(cut)?;
    let version = cursor.u8().zip(cursor.u8()).ok_or_else(cut)?.0;
    let length = if version == 1 { cursor.u16().map(usize::from) } else { cursor.length() }.ok_or_else(cut)?;
    if magic != b"\x93NUMPY" || !(1..=3).contains(&version) {
        return Err(damaged("no array of NumPy"));
    }
    let header = std::str::from_utf8(cursor.take(length).ok_or_else(cut)?).map_err(damaged)?;
    let layout = Layout::of(header).ok_or_else(|| damaged(format!("the header of {name} is not understood")))?;
    if layout.fields.iter().any(|field| field.kind.is_none()) {
        let message = format!("{name} holds no plain numbers: {}", header.trim());
        return Err(Error::new(&codes::NOT_A_NUMBER, message));
    }
    layout.read(cursor, name).ok_or_else(|| damaged(format!("the shape of {name} is larger than any file")))
}

/// What the header of an array says.
struct Layout {
    fields: Vec<Field>,
    by_columns: bool,
    shape: (usize, usize),
}

struct Field {
    name: Option<String>,
    kind: Option<Kind>,
    size: usize,
    count: usize,
    big_endian: bool,
}

impl Layout {
    /// Reads the dictionary `{'descr': '<f8', 'fortran_order': False, 'shape': (3, 2), }`.
    fn of(header: &str) -> Option<Self> {
        let after = |key: &str| header.split_once(key).map(|(_, rest)| rest.trim_start_matches([' ', ':', '\'', '"']));
        let by_columns = after("fortran_order")?.starts_with("True");
        let (_, shape) = after("'shape'")?.split_once('(')?;
        let numbers = shape.split_once(')')?.0.split(',').map(str::trim).filter(|number| !number.is_empty());
        let shape: Vec<usize> = numbers.map(|number| number.parse().ok()).collect::<Option<_>>()?;
        let shape = match shape[..] {
            [] => (1, 1),
            [rows] => (rows, 1),
            [rows, columns] => (rows, columns),
            // Further dimensions lie within the second.
            [rows, ref inner @ ..] if !by_columns => {
                (rows, inner.iter().try_fold(1, |all: usize, one| all.checked_mul(*one))?)
            }
            _ => return None,
        };
        let description = header.split_once("'descr'")?.1.trim_start_matches([' ', ':']);
        let fields = match description.strip_prefix('[') {
            None => vec![Field::of(None, quoted(description)?, 1)?],
            Some(list) => structure(list)?,
        };
        Some(Self { fields, by_columns, shape })
    }

    /// The numbers that are there; `None` where the shape is beyond any.
    fn read(&self, mut cursor: Cursor, name: &str) -> Option<(Vec<Array>, usize)> {
        let (rows, width) = self.shape;
        let total = rows.checked_mul(width)?;
        let item: usize = self
            .fields
            .iter()
            .try_fold(0, |all: usize, field| all.checked_add(field.size.checked_mul(field.count)?))?;
        total.checked_mul(item).filter(|_| item > 0)?;
        let mut values: Vec<Vec<Number>> = vec![Vec::new(); self.fields.len()];
        'items: for _ in 0..total {
            let Some(bytes) = cursor.take(item) else { break };
            let mut item = Cursor::new(bytes, false);
            for (field, values) in self.fields.iter().zip(&mut values) {
                item.big_endian = field.big_endian;
                for _ in 0..field.count {
                    let Some(number) = item.number(field.kind?, field.size) else { break 'items };
                    values.push(number);
                }
            }
        }
        let read = values.first().map_or(0, |values| values.len() / self.fields[0].count.max(1));
        let whole = if self.by_columns && read < total { 0 } else { read / width.max(1) };
        let array = |(field, values): (&Field, Vec<Number>)| {
            let column = field.name.clone().unwrap_or_else(|| name.to_owned());
            Array { name: column, shape: (whole, width * field.count), by_columns: self.by_columns, values }
        };
        Some((self.fields.iter().zip(values).map(array).collect(), rows - whole))
    }
}

impl Field {
    /// A type such as `<f8`.
    fn of(name: Option<String>, text: &str, count: usize) -> Option<Self> {
        let order = text.chars().next()?;
        let kind = match text.get(1..2)? {
            "f" => Some(Kind::Float),
            "i" | "m" | "M" => Some(Kind::Signed),
            "u" | "b" => Some(Kind::Unsigned),
            _ => None,
        };
        let digits: String = text.get(2..)?.chars().take_while(char::is_ascii_digit).collect();
        let size = digits.parse().unwrap_or(0);
        let kind = kind.filter(|_| matches!(size, 1 | 2 | 4 | 8));
        Some(Self { name, kind, size, count, big_endian: order == '>' })
    }
}

/// The first text in quotation marks.
fn quoted(text: &str) -> Option<&str> {
    text.split(['\'', '"']).nth(1)
}

/// The fields `('t', '<f8'), ('q', '<f8', (3,))` of a structure.
fn structure(list: &str) -> Option<Vec<Field>> {
    let mut fields = Vec::new();
    let mut rest = list;
    while let Some((_, field)) = rest.split_once('(') {
        let mut parts = field.splitn(5, ['\'', '"']);
        let (name, kind, tail) = (parts.nth(1)?, parts.nth(1)?, parts.next()?);
        let (inner, after) = match tail.trim_start_matches([',', ' ']).strip_prefix('(') {
            Some(shape) => shape.split_once(')')?,
            None => ("", tail),
        };
        let sides = inner.split(',').map(str::trim).filter(|side| !side.is_empty());
        let count = sides.map(str::parse::<usize>).try_fold(1_usize, |all, side| all.checked_mul(side.ok()?))?;
        fields.push(Field::of(Some(name.to_owned()), kind, count)?);
        rest = after.split_once(')')?.1;
        if rest.trim_start().starts_with(']') {
            break;
        }
    }
    (!fields.is_empty()).then_some(fields)
}
