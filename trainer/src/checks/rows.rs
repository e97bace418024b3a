//! Rows of a recording: all but some, and when they were.

use crate::recording::{Quantity, Recording};

/// The stretches of time that increasing rows cover, the rows in one stretch being neighbours.
pub(super) fn stretches(recording: &Recording, rows: &[usize]) -> Vec<[f64; 2]> {
    let Some(time) = recording.values(Quantity::Time) else { return Vec::new() };
    let neighbours = rows.chunk_by(|before, row| *row == before + 1);
    neighbours.map(|run| [time[run[0]], time[run[run.len() - 1]]]).collect()
}

/// All rows but these (increasing indices).
pub(super) fn others(len: usize, left_out: &[usize]) -> Vec<usize> {
    (0..len).filter(|row| left_out.binary_search(row).is_err()).collect()
}
