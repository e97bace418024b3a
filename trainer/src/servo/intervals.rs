//! How far the recordings determine the constants of a trajectory: by the errors that it leaves, by what was known before, and by what a command did
//! between two rows of the log.

use nalgebra::{DMatrix, DVector};

use super::candidate::{Candidate, What};
use super::commanded::Commanded;
use super::moved::{Moved, Starts};
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

    /// Half of the 95 % intervals of what is moved: those of the errors that are `left`, rad, and how far a curve through the commands, in finer steps,
    /// moves the constant in place of the line from row to row; where the joint can be simulated under that.
    pub(super) fn half_widths(
        &self,
        moved: &[Moved],
        (candidate, left): (&Candidate, &[f64]),
        commanded: &[Commanded<'_>],
        starts: &Starts,
    ) -> Vec<(What, f64)> {
        let variance = independent_variance(left, commanded);
        // What changes nothing takes no part and is not determined.
        let told: Vec<usize> = (0..moved.len()).filter(|&index| self.normal[(index, index)] > 0.0).collect();
        let Some(covariance) = self.normal.select_rows(&told).select_columns(&told).try_inverse() else {
            return moved.iter().map(|constant| (constant.what, f64::INFINITY)).collect();
        };
        let shift = match by_curve(candidate, left, commanded, starts) {
            Ok(by_curve) => {
                let pull = DVector::from_iterator(told.len(), told.iter().map(|&index| self.along(index, &by_curve)));
                &covariance * pull
            }
            Err(_) => DVector::zeros(told.len()),
        };
        let of = |(index, constant): (usize, &Moved)| {
            let half = told.iter().position(|told| *told == index).map_or(f64::INFINITY, |place| {
                NORMAL_95 * (variance * covariance[(place, place)].abs()).sqrt() + shift[place].abs()
            });
            (constant.what, constant.scale * half)
        };
        moved.iter().enumerate().map(of).collect()
    }
}

/// What a curve through the commands changes of the simulated positions, rad, whose errors along the line from row to row are `left`, rad.
fn by_curve(candidate: &Candidate, left: &[f64], commanded: &[Commanded<'_>], starts: &Starts) -> Result<Vec<f64>> {
    let mut changes = Vec::with_capacity(left.len());
    for (one, starts) in commanded.iter().zip(starts) {
        let begun: Vec<usize> = starts.iter().map(|(row, _)| *row).collect();
        let (series, places) = one.series.on_a_curve(FINER, &begun);
        let later: Vec<_> = starts.iter().map(|(row, state)| (places[*row], *state)).collect();
        let curve = candidate.states(one, &series, &later)?;
        let first = later.first().map_or(0, |(row, _)| *row);
        let at_rows = places.iter().filter(|place| **place >= first).map(|place| &curve[place - first]);
        changes.extend(at_rows.zip(one.positions()).map(|(curve, recorded)| curve.position - recorded));
    }
    changes.iter_mut().zip(left).for_each(|(change, left)| *change -= left);
    Ok(changes)
}
