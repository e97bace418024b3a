//! Named arrays, as NumPy and MATLAB keep them, side by side as the columns of one table.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use super::cursor::Number;
use crate::error::{Error, Result, codes};
use crate::recording::clock;
use crate::recording::quantity::Quantity;
use crate::recording::table::{RawTable, TableBuilder};

/// An array of one or two dimensions.
#[derive(Clone, Debug)]
pub(super) struct Array {
    pub(super) name: String,
    /// Rows and columns; a list has one column.
    pub(super) shape: (usize, usize),
    /// Whether columns follow one another in `values`, instead of rows.
    pub(super) by_columns: bool,
    pub(super) values: Vec<Number>,
}

impl Array {
    /// Its length as a signal: the longer side; none of an empty array, whatever its other side claims.
    fn length(&self) -> usize {
        if self.shape.0.min(self.shape.1) == 0 { 0 } else { self.shape.0.max(self.shape.1) }
    }

    fn is_time(&self) -> bool {
        clock::is_named(&self.name) || matches!(Quantity::of_column(&self.name), Some((Quantity::Time, _)))
    }

    /// The same array with time along its rows.
    fn standing(self, rows: usize) -> Self {
        if self.shape.0 == rows {
            return self;
        }
        Self { shape: (self.shape.1, self.shape.0), by_columns: !self.by_columns, ..self }
    }

    fn at(&self, row: usize, column: usize) -> Option<Number> {
        let index = if self.by_columns { column * self.shape.0 + row } else { row * self.shape.1 + column };
        self.values.get(index).copied()
    }
}

/// Puts arrays of one length side by side: that of the time, else the one that most have. Others are noted and left out.
///
/// # Errors
/// `FRK-D001` where there is none.
pub(super) fn table_of(arrays: Vec<Array>) -> Result<RawTable> {
    let mut lengths: BTreeMap<usize, usize> = BTreeMap::new();
    for array in &arrays {
        *lengths.entry(array.length()).or_default() += 1;
    }
    let of_time = arrays.iter().filter(|array| array.is_time()).map(Array::length).max().filter(|length| *length > 1);
    let most = lengths.iter().filter(|(length, _)| **length > 1).max_by_key(|(length, count)| (**count, **length));
    let Some(rows) = of_time.or(most.map(|(length, _)| *length)) else {
        return Err(Error::new(&codes::EMPTY_FILE, "the file holds no array of numbers longer than one"));
    };
    let (columns, others): (Vec<Array>, Vec<Array>) =
        arrays.into_iter().partition(|array| array.shape.0 == rows || array.shape.1 == rows);
    let columns: Vec<Array> = columns.into_iter().map(|array| array.standing(rows)).collect();
    let mut header = Vec::new();
    for Array { name, shape: (_, width), .. } in &columns {
        match width {
            1 => header.push(name.clone()),
            width => header.extend((0..*width).map(|column| format!("{name}[{column}]"))),
        }
    }
    let mut builder = TableBuilder::new(header, 1, &[])?;
    let (mut text, mut ends) = (String::new(), Vec::new());
    for row in 0..rows {
        text.clear();
        ends.clear();
        for array in &columns {
            for column in 0..array.shape.1 {
                if let Some(number) = array.at(row, column) {
                    // Writing to a string cannot fail.
                    let _ = write!(text, "{number}");
                }
                ends.push(text.len());
            }
        }
        let start = |index: usize| if index == 0 { 0 } else { ends[index - 1] };
        builder.push(row as u64 + 1, (0..ends.len()).map(|index| &text[start(index)..ends[index]]))?;
    }
    let left_out = others.iter().filter(|array| array.length() > 1);
    let notes =
        left_out.map(|array| format!("{} has another length than the others and was left out", array.name)).collect();
    Ok(RawTable { notes, ..builder.finish() })
}
