//! How far the recordings determine the constants of a trajectory: by the errors that it leaves, by what was known before, and by what a command did
//! between two rows of the log.

use nalgebra::{DMatrix, DVector};

use super::candidate::{Candidate, What};
use super::commanded::Commanded;
use super::shooting::{Moved, Starts};
use crate::error::Result;
use crate::numerics::statistics::NORMAL_95;

/// Errors of the position within this time tell the same, s: from the decay of a joint's own motion.
const CORRELATION_S: f64 = 0.2;
/// Rows in place of one on the curve through the commands: what is left between such a curve and its chords is a sixteenth.
const FINER: usize = 4;

/// Variance of the errors of the position, those within the correlation time counted as one, rad2.
pub(super) fn independent_variance(left: &[f64], commanded: &[Commanded<'_>]) -> f64 {
    let period = commanded.first().and_then(|one| one.recording.health.period_s).unwrap_or(CORRELATION_S);
    left.iter().map(|x| x * x).sum::<f64>() / left.len().max(1) as f64 * (CORRELATION_S / period).max(1.0)
}

/// The problem of least squares about a candidate, in units of the scales of what is moved.
pub(super) struct Linearised {
    /// Curvature of the cost.
    pub(super) normal: DMatrix<f64>,
    /// Derivatives of the positions, and the weights of their errors.
    pub(super) slopes: Vec<Vec<f64>>,
    pub(super) weights: Vec<f64>,
}

impl Linearised {
    /// Sum over all rows of the derivative by a constant times something else.
    pub(super) fn along(&self, constant: usize, other: &[f64]) -> f64 {
        self.slopes[constant].iter().zip(other).zip(&self.weights).map(|((a, b), w)| a * b * w).sum()
    }

    /// Half of the 95 % intervals of what is moved: those of the errors that are `left`, rad, and how far a curve through the commands in place of
    /// the line from row to row moves the constant.
    ///
    /// # Errors
    /// `FRK-N004` where the joint cannot be simulated under that curve.
    pub(super) fn half_widths(
        &self,
        moved: &[Moved],
        (candidate, left): (&Candidate, &[f64]),
        commanded: &[Commanded<'_>],
        starts: &Starts,
    ) -> Result<Vec<(What, f64)>> {
        let variance = independent_variance(left, commanded);
        // What changes nothing takes no part and is not determined.
        let told: Vec<usize> = (0..moved.len()).filter(|&index| self.normal[(index, index)] > 0.0).collect();
        let Some(covariance) = self.normal.select_rows(&told).select_columns(&told).try_inverse() else {
            return Ok(moved.iter().map(|constant| (constant.what, f64::INFINITY)).collect());
        };
        let by_curve = by_curve(candidate, commanded, starts)?;
        let pull = DVector::from_iterator(told.len(), told.iter().map(|&index| self.along(index, &by_curve)));
        let shift = &covariance * pull;
        let of = |(index, constant): (usize, &Moved)| {
            let half = told.iter().position(|told| *told == index).map_or(f64::INFINITY, |place| {
                NORMAL_95 * (variance * covariance[(place, place)].abs()).sqrt() + shift[place].abs()
            });
            (constant.what, constant.scale * half)
        };
        Ok(moved.iter().enumerate().map(of).collect())
    }
}

/// What a curve through the commands in place of the line from row to row changes of the simulated positions, rad.
fn by_curve(candidate: &Candidate, commanded: &[Commanded<'_>], starts: &Starts) -> Result<Vec<f64>> {
    let mut changes = Vec::new();
    for (one, starts) in commanded.iter().zip(starts) {
        let later: Vec<_> = starts.iter().map(|(row, state)| (FINER * row, *state)).collect();
        let line = candidate.states(one, &one.series, starts)?;
        let curve = candidate.states(one, &one.series.on_a_curve(FINER), &later)?;
        changes.extend(curve.iter().step_by(FINER).zip(&line).map(|(curve, line)| curve.position - line.position));
    }
    Ok(changes)
}
