//! MATLAB's `.mat` of version 5 to 7 (MathWorks, MAT-File Format, level 5): arrays of numbers, alone or in structures.

use std::io::Read;

use flate2::read::ZlibDecoder;

use super::arrays::{Array, table_of};
use super::cursor::{Cursor, Kind, Number};
use super::{WHOLE_LIMIT_BYTES, damaged};
use crate::error::{Error, Result, codes};
use crate::recording::table::RawTable;

/// Bytes before the first element: text, and at its end the order of bytes.
const HEADER_BYTES: usize = 128;

/// Structures within structures that are followed.
const DEEPEST: usize = 16;

/// Types of elements that are no plain numbers.
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;

/// Classes of arrays: structures, and numbers from double to uint64.
const STRUCTURE: u32 = 2;
const NUMBERS: std::ops::RangeInclusive<u32> = 6..=15;

/// Bit of the flags of an array that has an imaginary part.
const COMPLEX: u32 = 0x0800;

/// Reads every array of numbers; those of a structure are named by their fields.
pub(super) fn read(bytes: &[u8]) -> Result<RawTable> {
    let header = bytes.get(..HEADER_BYTES).ok_or_else(cut)?;
    let mut file = File { arrays: Vec::new(), room: WHOLE_LIMIT_BYTES };
    let mut cursor = Cursor::new(&bytes[HEADER_BYTES..], header[126..] == *b"MI");
    while !cursor.is_at_end() {
        let element = Element::next(&mut cursor).ok_or_else(cut)?;
        file.element(element, cursor.big_endian)?;
    }
    let mut arrays = file.arrays;
    // Where all lie in one structure, its name says nothing.
    while let Some((first, _)) = arrays.first().and_then(|array| array.name.split_once('.')) {
        let prefix = format!("{first}.");
        if !arrays.iter().all(|array| array.name.starts_with(&prefix)) {
            break;
        }
        arrays.iter_mut().for_each(|array| drop(array.name.drain(..prefix.len())));
    }
    table_of(arrays)
}

fn cut() -> Error {
    Error::new(&codes::CUT_SHORT, "the file ends within an array")
}

/// A type and the bytes of that type.
struct Element<'a> {
    kind: u32,
    data: &'a [u8],
}

impl<'a> Element<'a> {
    fn next(cursor: &mut Cursor<'a>) -> Option<Self> {
        let tag = cursor.u32()?;
        // Up to four bytes stand within the tag itself, with their number in its upper half.
        if tag >> 16 != 0 {
            let size = (tag >> 16) as usize;
            let data = cursor.take(4)?.get(..size)?;
            return Some(Self { kind: tag & 0xffff, data });
        }
        let size = cursor.length()?;
        let data = cursor.take(size)?;
        if tag != COMPRESSED {
            cursor.align(8);
        }
        Some(Self { kind: tag, data })
    }

    fn numbers(&self, big_endian: bool) -> Option<Vec<Number>> {
        let (kind, size) = match self.kind {
            1 => (Kind::Signed, 1),
            2 => (Kind::Unsigned, 1),
            3 => (Kind::Signed, 2),
            4 => (Kind::Unsigned, 2),
            5 => (Kind::Signed, 4),
            6 => (Kind::Unsigned, 4),
            7 => (Kind::Float, 4),
            9 => (Kind::Float, 8),
            12 => (Kind::Signed, 8),
            13 => (Kind::Unsigned, 8),
            _ => return None,
        };
        let mut cursor = Cursor::new(self.data, big_endian);
        (0..self.data.len() / size).map(|_| cursor.number(kind, size)).collect()
    }

    fn text(&self) -> String {
        String::from_utf8_lossy(self.data).trim_end_matches('\0').to_owned()
    }
}

struct File {
    arrays: Vec<Array>,
    /// Bytes that may still be decompressed.
    room: u64,
}

impl File {
    fn element(&mut self, element: Element, big_endian: bool) -> Result<()> {
        match element.kind {
            COMPRESSED => {
                let mut inner = Vec::new();
                let decoded = ZlibDecoder::new(element.data).take(self.room + 1).read_to_end(&mut inner);
                decoded.map_err(|error| damaged(format!("a compressed array, {error}")))?;
                self.room = self.room.checked_sub(inner.len() as u64).ok_or_else(|| {
                    let message = format!("the arrays have more than {WHOLE_LIMIT_BYTES} bytes together");
                    Error::new(&codes::FILE_TOO_LARGE, message)
                })?;
                let mut cursor = Cursor::new(&inner, big_endian);
                let element = Element::next(&mut cursor).ok_or_else(cut)?;
                if element.kind == MATRIX { self.matrix(element.data, big_endian, "", 0) } else { Ok(()) }
            }
            MATRIX => self.matrix(element.data, big_endian, "", 0),
            _ => Ok(()),
        }
    }

    /// Takes up an array and what lies in it; `path` is that of the structure that holds it.
    fn matrix(&mut self, data: &[u8], big_endian: bool, path: &str, depth: usize) -> Result<()> {
        // An empty field has no bytes at all.
        if data.is_empty() || depth > DEEPEST {
            return Ok(());
        }
        let mut cursor = Cursor::new(data, big_endian);
        let mut next = || Element::next(&mut cursor).ok_or_else(cut);
        let flags = next()?.numbers(big_endian);
        let sides = next()?.numbers(big_endian);
        let own = next()?.text();
        let Some(Number::Whole(flags)) = flags.and_then(|flags| flags.first().copied()) else { return Ok(()) };
        let flags = u32::try_from(flags).unwrap_or(0);
        let name = if own.is_empty() { path.to_owned() } else { own };
        let class = flags & 0xff;
        if class == STRUCTURE {
            return self.structure(cursor, &name, depth);
        }
        if !NUMBERS.contains(&class) || flags & COMPLEX != 0 {
            return Ok(());
        }
        let side = |number: &Number| match number {
            Number::Whole(side) => usize::try_from(*side).ok(),
            Number::Float(_) => None,
        };
        let sides: Option<Vec<usize>> = sides.unwrap_or_default().iter().map(side).collect();
        let Some([rows, inner @ ..]) = sides.as_deref() else { return Ok(()) };
        let columns = inner.iter().try_fold(1_usize, |all, side| all.checked_mul(*side));
        let values = Element::next(&mut cursor).ok_or_else(cut)?.numbers(big_endian).unwrap_or_default();
        if columns.and_then(|columns| columns.checked_mul(*rows)) != Some(values.len()) {
            return Err(damaged(format!("{name} has not as many values as its shape says")));
        }
        if !values.is_empty() {
            let shape = (*rows, columns.unwrap_or(1));
            self.arrays.push(Array { name, shape, by_columns: true, values });
        }
        Ok(())
    }

    /// Takes up the fields of a structure, element by element.
    fn structure(&mut self, mut cursor: Cursor, name: &str, depth: usize) -> Result<()> {
        let big_endian = cursor.big_endian;
        let length =
            Element::next(&mut cursor).ok_or_else(cut)?.numbers(big_endian).and_then(|one| one.first().copied());
        let Some(Number::Whole(length @ 1..)) = length else { return Ok(()) };
        let names = Element::next(&mut cursor).ok_or_else(cut)?;
        let names: Vec<String> = names
            .data
            .chunks(usize::try_from(length).unwrap_or(usize::MAX))
            .map(|name| String::from_utf8_lossy(name).split('\0').next().unwrap_or_default().to_owned())
            .collect();
        let mut index = 0;
        while !cursor.is_at_end() && !names.is_empty() {
            let (place, repeat) = (index % names.len(), index / names.len());
            let again = if repeat == 0 { String::new() } else { format!("({})", repeat + 1) };
            let path = format!("{name}{again}.{}", names[place]);
            let element = Element::next(&mut cursor).ok_or_else(cut)?;
            if element.kind == MATRIX {
                self.matrix(element.data, big_endian, &path, depth + 1)?;
            }
            index += 1;
        }
        Ok(())
    }
}
