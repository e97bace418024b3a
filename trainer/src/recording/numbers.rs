//! The numbers of a column.

use std::ops::Range;

/// The numbers of a column as they stand in the file; not finite where a cell is empty, says so, or is text.
#[derive(Clone, Debug, Default)]
pub(super) struct Numbers {
    /// Empty where the column is not kept.
    pub(super) values: Vec<f64>,
    /// Cells that are empty or not finite.
    pub(super) missing: usize,
    /// Whether a cell is neither a number nor missing.
    pub(super) is_text: bool,
    /// Line and text of the first cell that is no finite number.
    pub(super) refused: Option<(u64, String)>,
}

impl Numbers {
    /// Takes the cell of the next row in, which stands on a line of the file.
    pub(super) fn push(&mut self, cell: &str, decimal_comma: bool, line: u64) {
        let number = number(cell, decimal_comma).ok();
        let finite = number.filter(|value| value.is_finite());
        if finite.is_none() {
            let missing = cell.is_empty() || number.is_some();
            self.missing += usize::from(missing);
            self.is_text |= !missing;
            self.refused.get_or_insert_with(|| (line, cell.to_owned()));
        }
        self.values.push(finite.unwrap_or(f64::NAN));
    }

    /// Keeps stretches of the rows alone (in order and apart), in place.
    pub(super) fn keep(&mut self, stretches: &[Range<usize>]) {
        // A column that was left out has none.
        let stretches = if self.values.is_empty() { &[] } else { stretches };
        let mut end = 0;
        for stretch in stretches {
            self.values.copy_within(stretch.clone(), end);
            end += stretch.len();
        }
        self.values.truncate(end);
        if !self.is_text {
            self.missing = self.values.iter().filter(|value| value.is_nan()).count();
        }
    }
}

/// The number that a cell holds.
pub(super) fn number(field: &str, decimal_comma: bool) -> std::result::Result<f64, std::num::ParseFloatError> {
    match field.parse::<f64>() {
        Err(_) if decimal_comma && !field.contains('.') => field.replacen(',', ".", 1).parse(),
        other => other,
    }
}
