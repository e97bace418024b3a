//! The text of a recording as it was, so that a command can copy its columns unchanged, with the numbers of its
//! columns; numbers of other formats in their shortest text.

use std::collections::HashSet;
use std::ops::Range;

use super::keep::{InUse, Keep, Thinning};
use super::numbers::{Numbers, number};
use super::vectors::{self, Expansion};
use crate::error::{Error, Result, codes};

/// Rows at the start whose text is kept in any case: layout and clock are told from them.
const FIRST_ROWS: usize = 200;

/// Numbers below this are held to their billionths by a double.
pub(super) const EXACT: f64 = (1_u64 << 53) as f64 * 1e-9;

/// Header and rows of a recording as text.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TextTable {
    header: Vec<String>,
    header_line: u64,
    columns: Vec<Cells>,
    rows: usize,
    /// Rows that do not stand on the line behind that of the row before, with their lines.
    jumps: Vec<(usize, u64)>,
}

/// The cells of a column from the first row on, in one allocation.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Cells {
    text: String,
    ends: Vec<usize>,
}

impl Cells {
    fn push(&mut self, cell: &str) {
        self.text.push_str(cell);
        self.ends.push(self.text.len());
    }

    fn get(&self, row: usize) -> Option<&str> {
        let end = *self.ends.get(row)?;
        let start = if row == 0 { 0 } else { self.ends[row - 1] };
        Some(&self.text[start..end])
    }
}

impl TextTable {
    fn new(header: Vec<String>, header_line: u64) -> Self {
        let columns = vec![Cells::default(); header.len()];
        Self { header, header_line, columns, ..Self::default() }
    }

    fn begin_row(&mut self, line: u64) {
        if self.rows == 0 || self.line(self.rows) != line {
            self.jumps.push((self.rows, line));
        }
        self.rows += 1;
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
        self.rows
    }

    /// Whether there is no row of data.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows == 0
    }

    /// Line number in the file of row `index` (counted from zero), the header being line 1.
    #[must_use]
    pub fn line(&self, index: usize) -> u64 {
        let jump = self.jumps[self.jumps.partition_point(|(row, _)| *row <= index) - 1];
        jump.1 + (index - jump.0) as u64
    }

    /// The field of a row in a column, both counted from zero; empty where its text was not kept.
    #[must_use]
    pub fn cell(&self, row: usize, column: usize) -> &str {
        self.kept(row, column).unwrap_or_default()
    }

    /// The same; `None` where its text was not kept.
    pub(super) fn kept(&self, row: usize, column: usize) -> Option<&str> {
        self.columns[column].get(row)
    }

    /// The fields of row `index`, counted from zero.
    pub fn row(&self, index: usize) -> impl Iterator<Item = &str> {
        self.columns.iter().map(move |cells| cells.get(index).unwrap_or_default())
    }

    /// The same columns with the rows `kept` only (increasing indices); a row keeps its line number.
    pub(super) fn with_rows(&self, kept: &[usize]) -> Self {
        let mut table = Self::new(self.header.clone(), self.header_line);
        kept.iter().for_each(|row| table.begin_row(self.line(*row)));
        for (cells, own) in table.columns.iter_mut().zip(&self.columns) {
            kept.iter().map_while(|row| own.get(*row)).for_each(|cell| cells.push(cell));
        }
        table
    }

    /// Forgets the text of the rows.
    pub(super) fn forget_text(&mut self) {
        self.columns.iter_mut().for_each(|cells| *cells = Cells::default());
    }

    /// Stretches of the rows (in order and apart) without their text; a row keeps its line number.
    pub(super) fn excerpt(&self, stretches: &[Range<usize>]) -> Self {
        let mut table = Self::new(self.header.clone(), self.header_line);
        stretches.iter().cloned().flatten().for_each(|row| table.begin_row(self.line(row)));
        table
    }

    /// The same rows with the columns `kept` only (increasing indices).
    fn with_columns(&self, kept: &[usize]) -> Self {
        Self {
            header: kept.iter().map(|column| self.header[*column].clone()).collect(),
            header_line: self.header_line,
            columns: kept.iter().map(|column| self.columns[*column].clone()).collect(),
            rows: self.rows,
            jumps: self.jumps.clone(),
        }
    }
}

/// A table that has been read but not yet interpreted.
#[derive(Debug)]
pub(super) struct RawTable {
    pub(super) table: TextTable,
    /// One for each column.
    pub(super) numbers: Vec<Numbers>,
    /// Cells of a row of units under the header, one a column; empty where there is no such row.
    pub(super) units: Vec<String>,
    pub(super) decimal_comma: bool,
    /// What was noticed on the way, one sentence each.
    pub(super) notes: Vec<String>,
    /// Whether the rows are stretches of those of the file.
    pub(super) is_excerpt: bool,
}

impl RawTable {
    /// The error of a field that is no finite number.
    pub(super) fn refusal(&self, field: &str, line: u64, column: &str) -> Error {
        let here = |code, message: &str| Error::new(code, message).at_row(line).in_column(column).with_value(field);
        match number(field, self.decimal_comma) {
            Ok(_) => here(&codes::NOT_FINITE, "this value is not finite"),
            Err(_) if field.is_empty() => here(&codes::NOT_A_NUMBER, "this field is empty"),
            Err(_) => here(&codes::NOT_A_NUMBER, "this is not a number"),
        }
    }

    /// The same rows with the columns `kept` only (increasing indices).
    pub(super) fn with_columns(&self, kept: &[usize]) -> Self {
        let units =
            if self.units.is_empty() { Vec::new() } else { kept.iter().map(|c| self.units[*c].clone()).collect() };
        Self {
            table: self.table.with_columns(kept),
            numbers: kept.iter().map(|c| self.numbers[*c].clone()).collect(),
            units,
            decimal_comma: self.decimal_comma,
            notes: self.notes.clone(),
            is_excerpt: self.is_excerpt,
        }
    }

    /// The cell under a column's name in a row of units, empty where there is none.
    pub(super) fn unit_below(&self, column: usize) -> &str {
        self.units.get(column).map_or("", String::as_str)
    }
}

/// Takes rows in; cells that hold a list become a column for each element.
#[derive(Debug)]
pub(super) struct TableBuilder<'a> {
    file_header: Vec<String>,
    expansion: Expansion,
    table: TextTable,
    numbers: Vec<Numbers>,
    decimal_comma: bool,
    keep: Keep<'a>,
    /// Whether columns were left out, by their places.
    left_out: Vec<bool>,
    thinning: Thinning,
}

impl<'a> TableBuilder<'a> {
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
        let (numbers, table) = (vec![Numbers::default(); names.len()], TextTable::new(names, header_line));
        let left_out = vec![false; numbers.len()];
        Ok(Self {
            file_header: header,
            expansion,
            table,
            numbers,
            decimal_comma: false,
            keep: Keep::Text,
            left_out,
            thinning: Thinning::none(),
        })
    }

    /// The same for numbers with a comma for their point or without, of whose text only so much is kept.
    pub(super) fn reading(self, decimal_comma: bool, keep: Keep<'a>) -> Self {
        let thinning = match keep {
            Keep::Text => Thinning::none(),
            Keep::Numbers(in_use) => in_use.thinning(&self.table.header),
        };
        Self { decimal_comma, keep, thinning, ..self }
    }

    /// Adds a cell to the row that was begun last.
    fn push_field(&mut self, column: usize, cell: &str, line: u64) {
        if self.left_out[column] {
            return;
        }
        let (numbers, row) = (&mut self.numbers[column], self.table.len() - 1);
        numbers.push(cell, self.decimal_comma, line);
        // A double holds the billionths of numbers below that; NaN, where the first cell is no number, is not below anything.
        let is_exact = numbers.values[0].abs() < EXACT;
        if matches!(self.keep, Keep::Text) || row < FIRST_ROWS || !is_exact {
            self.table.columns[column].push(cell);
        }
    }

    /// Adds a row that has as many cells as the header.
    ///
    /// # Errors
    /// `FRK-D007` where a list is shorter or longer than that of the first row.
    pub(super) fn push<'c>(&mut self, line: u64, cells: impl Iterator<Item = &'c str>) -> Result<()> {
        if !self.thinning.takes_next() {
            return Ok(());
        }
        if let Some(stretches) = self.thinning.make_room(self.table.len()) {
            self.numbers.iter_mut().for_each(|numbers| numbers.keep(&stretches));
            self.table = self.table.with_rows(&stretches.into_iter().flatten().collect::<Vec<usize>>());
        }
        self.table.begin_row(line);
        if let Keep::Numbers(in_use) = self.keep
            && self.table.len() == in_use.from_rows
        {
            self.leave_out(&in_use);
        }
        let mut column = 0;
        for (index, cell) in cells.enumerate() {
            let Some(length) = self.expansion.length(index) else {
                self.push_field(column, cell, line);
                column += 1;
                continue;
            };
            let mut count = 0;
            for element in vectors::elements(cell).into_iter().flatten() {
                if count < length {
                    self.push_field(column + count, element, line);
                }
                count += 1;
            }
            if cell.is_empty() {
                (0..length).for_each(|element| self.push_field(column + element, "", line));
            } else if count != length {
                let message = format!("this list has {count} elements, that of the first row has {length}");
                let error = Error::new(&codes::RAGGED_ROW, message).at_row(line);
                return Err(error.in_column(&self.file_header[index]).with_value(cell));
            }
            column += length;
        }
        Ok(())
    }

    /// Lets go of the columns that are not in use.
    fn leave_out(&mut self, in_use: &InUse) {
        for (column, _) in self.table.header.iter().enumerate().filter(|(_, name)| !in_use.holds(name)) {
            self.left_out[column] = true;
            self.numbers[column].values = Vec::new();
            self.table.columns[column] = Cells::default();
        }
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
        let Self { table, numbers, decimal_comma, left_out, thinning, .. } = self;
        let names = table.header.iter().zip(left_out).filter(|(_, left_out)| *left_out).map(|(name, _)| name.as_str());
        let names: Vec<&str> = names.filter(|name| !name.is_empty()).collect();
        let note = format!("too long for columns that nothing reads: {} left out", names.join(", "));
        let left_out = (!names.is_empty()).then_some(note);
        let notes: Vec<String> = left_out.into_iter().chain(thinning.note()).collect();
        let is_excerpt = thinning.note().is_some();
        RawTable { table, numbers, units: Vec::new(), decimal_comma, notes, is_excerpt }
    }
}
