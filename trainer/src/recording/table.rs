//! The text of a recording as it was, so that a command can copy its columns unchanged.

/// Header and rows of a recording as text, in one allocation.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TextTable {
    header: Vec<String>,
    text: String,
    ends: Vec<usize>,
    lines: Vec<u64>,
}

impl TextTable {
    pub(super) fn new(header: Vec<String>) -> Self {
        Self { header, ..Self::default() }
    }

    pub(super) fn begin_row(&mut self, line: u64) {
        self.lines.push(line);
    }

    pub(super) fn push_field(&mut self, field: &str) {
        self.text.push_str(field);
        self.ends.push(self.text.len());
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

    /// The fields of row `index`, counted from zero.
    pub fn row(&self, index: usize) -> impl Iterator<Item = &str> {
        let width = self.header.len();
        (index * width..(index + 1) * width).map(|field| self.field(field))
    }

    /// The same columns with the rows `kept` only (increasing indices); a row keeps its line number.
    pub(super) fn with_rows(&self, kept: &[usize]) -> Self {
        let mut table = Self::new(self.header.clone());
        for row in kept {
            table.begin_row(self.line(*row));
            self.row(*row).for_each(|field| table.push_field(field));
        }
        table
    }

    fn field(&self, index: usize) -> &str {
        let start = if index == 0 { 0 } else { self.ends[index - 1] };
        &self.text[start..self.ends[index]]
    }
}
