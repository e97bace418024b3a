//! What a network learns from: columns, blocks of rows, and their traversal in fixed chunks.

use std::ops::Range;

use rayon::prelude::*;

use crate::kan::network::error::KanError;

/// Rows that one work item covers. Results of work items are combined in order, so that the number of threads
/// does not show in a sum.
const CHUNK_ROWS: usize = 4096;

/// Work items whose results are held at the same time; bounds the memory of a pass over many samples.
const CHUNKS_IN_FLIGHT: usize = 16;

/// Rows to learn from and rows to judge by. Empty training ranges mean all rows that are not for validation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Blocks {
    /// Training rows.
    pub train: Vec<Range<usize>>,
    /// Validation rows; may be empty.
    pub validation: Vec<Range<usize>>,
}

/// Columns in physical units, borrowed.
#[derive(Clone, Copy, Debug)]
pub struct Dataset<'a> {
    /// One column per network input.
    pub inputs: &'a [Vec<f64>],
    /// What the network shall produce.
    pub target: &'a [f64],
    /// Columns that enter additively with a free coefficient each (acceleration, sin q, cos q, ...); may be empty.
    pub linear: &'a [Vec<f64>],
    /// Which rows serve for what.
    pub blocks: &'a Blocks,
}

impl Dataset<'_> {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.target.len()
    }

    /// Checks shapes, finiteness and block bounds.
    ///
    /// # Errors
    /// [`KanError::Shape`], [`KanError::NotFinite`] or [`KanError::TooFewRows`], for the first thing found.
    pub fn check(&self, inputs: usize) -> Result<(), KanError> {
        let shape = |what, expected, found| {
            if expected == found { Ok(()) } else { Err(KanError::Shape { what, expected, found }) }
        };
        shape("input columns", inputs, self.inputs.len())?;
        let named = self.inputs.iter().enumerate().map(|(i, column)| (format!("input {i}"), column.as_slice()));
        let linear =
            self.linear.iter().enumerate().map(|(i, column)| (format!("linear column {i}"), column.as_slice()));
        for (name, column) in named.chain(linear).chain([("target".to_owned(), self.target)]) {
            shape("rows of a column", self.rows(), column.len())?;
            if let Some(row) = column.iter().position(|value| !value.is_finite()) {
                return Err(KanError::NotFinite { column: name, row });
            }
        }
        for range in self.blocks.train.iter().chain(&self.blocks.validation) {
            if range.start > range.end || range.end > self.rows() {
                return Err(KanError::Shape { what: "end of a block", expected: self.rows(), found: range.end });
            }
        }
        let found = row_count(&self.training_rows());
        if found < MINIMUM_ROWS { Err(KanError::TooFewRows { found, needed: MINIMUM_ROWS }) } else { Ok(()) }
    }

    /// The training ranges, all other rows when none are given.
    pub(in crate::kan) fn training_rows(&self) -> Vec<Range<usize>> {
        if !self.blocks.train.is_empty() {
            return self.blocks.train.clone();
        }
        let mut held_out = self.blocks.validation.clone();
        held_out.sort_by_key(|range| range.start);
        let mut start = 0;
        let mut free = Vec::new();
        for range in held_out {
            if range.start > start {
                free.push(start..range.start);
            }
            start = start.max(range.end);
        }
        if start < self.rows() {
            free.push(start..self.rows());
        }
        free
    }
}

/// Training rows below which a fit is refused.
const MINIMUM_ROWS: usize = 4;

/// Number of rows in a list of ranges.
pub(in crate::kan) fn row_count(rows: &[Range<usize>]) -> usize {
    rows.iter().map(Range::len).sum()
}

/// Maps fixed chunks of rows, in parallel, and folds the results strictly in the order of the rows.
pub(in crate::kan) fn fold_chunks<T: Send, A>(
    rows: &[Range<usize>],
    start: A,
    map: impl Fn(&[Range<usize>]) -> T + Sync,
    mut fold: impl FnMut(A, T) -> A,
) -> A {
    let mut accumulated = start;
    for batch in chunks(rows).chunks(CHUNKS_IN_FLIGHT) {
        let parts: Vec<T> = match batch {
            [only] => vec![map(only)],
            many => many.par_iter().map(|chunk| map(chunk)).collect(),
        };
        for part in parts {
            accumulated = fold(accumulated, part);
        }
    }
    accumulated
}

/// The same rows, however many ranges they come in, as chunks of [`CHUNK_ROWS`]; the last may have fewer.
fn chunks(rows: &[Range<usize>]) -> Vec<Vec<Range<usize>>> {
    let mut chunks: Vec<Vec<Range<usize>>> = Vec::new();
    let mut room = 0;
    for range in rows {
        let mut begin = range.start;
        while begin < range.end {
            if room == 0 {
                chunks.push(Vec::new());
                room = CHUNK_ROWS;
            }
            let end = range.end.min(begin + room);
            chunks.last_mut().expect("one has room").push(begin..end);
            room -= end - begin;
            begin = end;
        }
    }
    chunks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chunks_cover_every_row_once_in_order() {
        let rows = [3..10, 20..20 + 3 * CHUNK_ROWS + 1];
        let seen = fold_chunks(
            &rows,
            Vec::new(),
            |chunk| chunk.iter().cloned().flatten().collect::<Vec<_>>(),
            |mut all, part| {
                all.extend(part);
                all
            },
        );
        let expected: Vec<usize> = rows.iter().cloned().flatten().collect();
        assert_eq!(seen, expected);
        assert_eq!(row_count(&rows), expected.len());
        let sizes: Vec<usize> = chunks(&rows).iter().map(|chunk| row_count(chunk)).collect();
        assert_eq!(sizes, [CHUNK_ROWS, CHUNK_ROWS, CHUNK_ROWS, 8]);
    }

    #[test]
    fn training_rows_are_those_not_held_out() {
        let target = vec![0.0; 10];
        let blocks = Blocks { train: vec![], validation: vec![6..8, 0..2] };
        let dataset = Dataset { inputs: &[], target: &target, linear: &[], blocks: &blocks };
        assert_eq!(dataset.training_rows(), [2..6, 8..10]);
    }

    #[test]
    fn says_what_is_wrong_with_the_data() {
        let blocks = Blocks::default();
        let target = vec![0.0; 5];
        let inputs = [vec![0.0, 1.0, f64::NAN, 3.0, 4.0]];
        let dataset = Dataset { inputs: &inputs, target: &target, linear: &[], blocks: &blocks };
        assert_eq!(dataset.check(1), Err(KanError::NotFinite { column: "input 0".into(), row: 2 }));
        assert!(matches!(dataset.check(2), Err(KanError::Shape { .. })));
    }
}
