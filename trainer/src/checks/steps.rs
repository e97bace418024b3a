//! Steps of a channel from row to row, and when something happens.

use crate::recording::{Quantity, Recording};

/// Steps below this share of the largest value are the text's rounding.
const ROUNDING: f64 = 1e-9;

/// Smallest step of a series above the rounding of its text; infinite where it never changes.
pub(super) fn resolution(values: &[f64]) -> f64 {
    let rounding = ROUNDING * values.iter().fold(0.0_f64, |peak, value| peak.max(value.abs()));
    let steps = values.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    steps.filter(|step| *step > rounding).fold(f64::INFINITY, f64::min)
}

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
