//! The text of a recording as it was, so that a command can copy its columns unchanged; numbers of other formats in their shortest text.

use std::collections::HashSet;

use super::vectors::{self, Expansion};
use crate::error::{Error, Result, codes};

/// Header and rows of a recording as text, in one allocation.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TextTable {
    header: Vec<String>,
    header_line: u64,
    text: String,
    ends: Vec<usize>,
    lines: Vec<u64>,
}

impl TextTable {
    fn new(header: Vec<String>, header_line: u64) -> Self {
        Self { header, header_line, ..Self::default() }
    }

    fn begin_row(&mut self, line: u64) {
        self.lines.push(line);
    }

    fn push_field(&mut self, field: &str) {
        self.text.push_str(field);
        self.ends.push(self.text.len());
    }

    /// Line number in the file of the header, 1 where the format has none.
    #[must_use]
    pub fn header_line(&self) -> u64 {
        self.header_line
    }

    /// Names of the columns, in the order of the file.
    #[must_use]
    pub fn header(&self) -> &[String] {
        &self.header
    }

    /// Number of rows of data.
    #[must_use]
    pub fn len(&self) -> usize {
        self.lines.len()
    }

    /// Whether there is no row of data.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.lines.is_empty()
    }

    /// Line number in the file of row `index` (counted from zero), the header being line 1.
    #[must_use]
    pub fn line(&self, index: usize) -> u64 {
        self.lines[index]
    }

    /// The field of a row in a column, both counted from zero.
    #[must_use]
    pub fn cell(&self, row: usize, column: usize) -> &str {
        self.field(row * self.header.len() + column)
    }

    /// The fields of row `index`, counted from zero.
    pub fn row(&self, index: usize) -> impl Iterator<Item = &str> {
        let width = self.header.len();
        (index * width..(index + 1) * width).map(|field| self.field(field))
    }

    /// The same columns with the rows `kept` only (increasing indices); a row keeps its line number.
    pub(super) fn with_rows(&self, kept: &[usize]) -> Self {
        let mut table = Self::new(self.header.clone(), self.header_line);
        for row in kept {
            table.begin_row(self.line(*row));
            self.row(*row).for_each(|field| table.push_field(field));
        }
        table
    }

    /// The same rows with the columns `kept` only (increasing indices).
    fn with_columns(&self, kept: &[usize]) -> Self {
        let header = kept.iter().map(|column| self.header[*column].clone()).collect();
        let mut table = Self::new(header, self.header_line);
        for row in 0..self.len() {
            table.begin_row(self.line(row));
            kept.iter().for_each(|column| table.push_field(self.cell(row, *column)));
        }
        table
    }

    fn field(&self, index: usize) -> &str {
        let start = if index == 0 { 0 } else { self.ends[index - 1] };
        &self.text[start..self.ends[index]]
    }
}

/// A table that has been read but not yet interpreted.
#[derive(Debug)]
pub(super) struct RawTable {
    pub(super) table: TextTable,
    /// Cells of a row of units under the header, one a column; empty where there is no such row.
    pub(super) units: Vec<String>,
    pub(super) decimal_comma: bool,
    /// What was noticed on the way, one sentence each.
    pub(super) notes: Vec<String>,
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

    /// The same rows with the columns `kept` only (increasing indices).
    pub(super) fn with_columns(&self, kept: &[usize]) -> Self {
        let units =
            if self.units.is_empty() { Vec::new() } else { kept.iter().map(|c| self.units[*c].clone()).collect() };
        Self {
            table: self.table.with_columns(kept),
            units,
            decimal_comma: self.decimal_comma,
            notes: self.notes.clone(),
        }
    }

    /// The cell under a column's name in a row of units, empty where there is none.
    pub(super) fn unit_below(&self, column: usize) -> &str {
        self.units.get(column).map_or("", String::as_str)
    }
}

/// Takes rows in; cells that hold a list become a column for each element.
#[derive(Debug)]
pub(super) struct TableBuilder {
    file_header: Vec<String>,
    expansion: Expansion,
    table: TextTable,
}

impl TableBuilder {
    /// A table of these columns, of which the first rows hold the cells `sample`.
    ///
    /// # Errors
    /// `FRK-D008` where two columns have one name.
    pub(super) fn new(header: Vec<String>, header_line: u64, sample: &[Vec<&str>]) -> Result<Self> {
        let expansion = Expansion::of(header.len(), sample.iter().cloned());
        let lists_joints = |name: &String| matches!(name.as_str(), "name" | "names" | "joint_names");
        let joints = header.iter().position(lists_joints).and_then(|index| sample.first()?.get(index).copied());
        let joints: Option<Vec<String>> =
            joints.and_then(vectors::elements).map(|names| names.map(str::to_owned).collect());
        let names = expansion.names(&header, joints.as_deref());
        let mut seen = HashSet::with_capacity(names.len());
        if let Some(name) = names.iter().find(|name| !name.is_empty() && !seen.insert(name.as_str())) {
            return Err(Error::new(&codes::DUPLICATE_COLUMN, "two columns have this name")
                .at_row(header_line)
                .in_column(name.as_str()));
        }
        Ok(Self { file_header: header, expansion, table: TextTable::new(names, header_line) })
    }

    /// Adds a row that has as many cells as the header.
    ///
    /// # Errors
    /// `FRK-D007` where a list is shorter or longer than that of the first row.
    pub(super) fn push<'a>(&mut self, line: u64, cells: impl Iterator<Item = &'a str>) -> Result<()> {
        self.table.begin_row(line);
        for (index, cell) in cells.enumerate() {
            let Some(length) = self.expansion.length(index) else {
                self.table.push_field(cell);
                continue;
            };
            let mut count = 0;
            for element in vectors::elements(cell).into_iter().flatten() {
                count += 1;
                if count <= length {
                    self.table.push_field(element);
                }
            }
            if cell.is_empty() {
                (0..length).for_each(|_| self.table.push_field(""));
            } else if count != length {
                let message = format!("this list has {count} elements, that of the first row has {length}");
                let error = Error::new(&codes::RAGGED_ROW, message).at_row(line);
                return Err(error.in_column(&self.file_header[index]).with_value(cell));
            }
        }
        Ok(())
    }

    /// One entry a column of the file, repeated for each element of its lists.
    pub(super) fn expanded(&self, entries: &[String]) -> Vec<String> {
        let repeated = |(index, entry)| std::iter::repeat_n(entry, self.expansion.length(index).unwrap_or(1)).cloned();
        entries.iter().enumerate().flat_map(repeated).collect()
    }

    /// Names of the columns as they are in the file.
    pub(super) fn file_header(&self) -> &[String] {
        &self.file_header
    }

    /// The table as it is to be interpreted.
    pub(super) fn finish(self) -> RawTable {
        RawTable { table: self.table, units: Vec::new(), decimal_comma: false, notes: Vec::new() }
    }
}
