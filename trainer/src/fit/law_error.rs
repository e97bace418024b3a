//! How wrong a shipped law is where it was fitted, beside the noise: what another recording may show of it is no physics that came later.

use super::data::gather::Material;
use super::filtered::predict_filtered;
use super::model::HostModel;
use crate::error::Result;
use crate::numerics::hat_functions::law_error_hats;
use crate::numerics::jackknife::ERROR_BLOCKS;
use crate::numerics::least_squares::{gram, moments, solve_symmetric};
use crate::numerics::regression::least_squares;
use crate::samples::top_speed;
use frikan_shared::model::{LawError, SLOW_SHARE};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Groups of blocks that are held out in turn: tenfold cross-validation (Stone 1974; Kohavi 1995 for the ten).
const FOLDS: usize = 10;
/// Rows without an error that each hat is given, so that one which few rows fall under says nothing.
const ROWS_WITHOUT_ERROR: f64 = 1.0;

/// What a model leaves of the torque that it was fitted to.
pub(super) struct Residual<'a> {
    /// Measured less predicted, one value a sample.
    pub(super) left: Vec<f64>,
    pub(super) velocity: &'a [f64],
    /// That of the law.
    pub(super) top_speed: f64,
}

impl<'a> Residual<'a> {
    /// # Errors
    /// As [`predict_filtered`].
    pub(super) fn of(model: &HostModel, material: &'a Material) -> Result<Self> {
        let samples = &material.samples;
        let measured = samples.friction.as_deref().or(samples.actuator.as_deref()).unwrap_or_default();
        let left = measured
            .iter()
            .zip(predict_filtered(model, material)?)
            .map(|(measured, predicted)| measured - predicted)
            .collect();
        let velocity = samples.velocity.as_deref().unwrap_or_default();
        let top_speed = model.top_speed().map_or_else(|| top_speed(velocity), f64::from);
        Ok(Self { left, velocity, top_speed })
    }
}

/// Error of a law over the rows that it was fitted to: what of its residual is a function of velocity and of whether the joint speeds up or
/// slows down, estimated on rows held out, and the standard error of a curve over speed.
pub(super) fn law_error(material: &Material, residual: &Residual<'_>) -> LawError {
    let Residual { left, velocity, top_speed } = residual;
    let acceleration = material.samples.acceleration.as_deref();
    let over = |is_slow: bool| {
        let counts = |position: &usize| (velocity[material.rows[*position]].abs() <= SLOW_SHARE * top_speed) == is_slow;
        let positions: Vec<usize> = (0..material.rows.len()).filter(counts).collect();
        let pick = |values: &[f64]| -> Vec<f64> {
            positions.iter().map(|&position| values[material.rows[position]]).collect()
        };
        let labels: Vec<usize> =
            positions.iter().map(|&position| position * ERROR_BLOCKS / material.rows.len()).collect();
        error_over(&pick(left), &pick(velocity), acceleration.map(pick).as_deref(), &labels, *top_speed) as f32
    };
    LawError { slow: over(true), sliding: over(false) }
}

/// Root mean square of the error in a residual; velocity, acceleration and block of each row, top speed.
fn error_over(left: &[f64], velocity: &[f64], acceleration: Option<&[f64]>, labels: &[usize], top: f64) -> f64 {
    if left.is_empty() {
        return 0.0;
    }
    let hats = |acceleration: Option<&[f64]>| law_error_hats(velocity, acceleration, top);
    let blocks = runs_of(labels);
    let energy = held_out_energy(&hats(acceleration), left, &blocks) + curve_variance(&hats(None), left, &blocks);
    (energy / left.len() as f64).sqrt()
}

/// Runs of positions with one label.
fn runs_of(labels: &[usize]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for run in labels.chunk_by(|a, b| a == b) {
        let begin = runs.last().map_or(0, |last| last.end);
        runs.push(begin..begin + run.len());
    }
    runs
}

/// Energy that columns, fitted to the blocks of the other folds, explain of a target in each fold; at least 0.
fn held_out_energy(columns: &[Vec<f64>], target: &[f64], blocks: &[Range<usize>]) -> f64 {
    let fold = |fold: usize| blocks.iter().skip(fold).step_by(FOLDS).cloned().collect::<Vec<_>>();
    let sums = |runs: Vec<Range<usize>>| (gram(columns, &runs), moments(columns, target, &runs));
    let folds: Vec<_> = (0..FOLDS.min(blocks.len())).map(fold).map(sums).collect();
    let width = columns.len();
    let mut explained = 0.0;
    for (index, (gram, moment)) in folds.iter().enumerate() {
        let mut normal = DMatrix::identity(width, width) * ROWS_WITHOUT_ERROR;
        let mut right = DVector::zeros(width);
        for (_, (gram, moment)) in folds.iter().enumerate().filter(|(other, _)| *other != index) {
            normal += gram;
            right += moment;
        }
        let Some(coefficients) = solve_symmetric(&normal, &right) else { continue };
        explained += 2.0 * coefficients.dot(moment) - (gram * &coefficients).dot(&coefficients);
    }
    explained.max(0.0)
}

/// Energy that noise alone gives a curve which is fitted to a target: the trace of its covariance, noise correlated within blocks.
fn curve_variance(curve: &[Vec<f64>], target: &[f64], blocks: &[Range<usize>]) -> f64 {
    let all = 0..target.len();
    (least_squares(curve, target, blocks).covariance * gram(curve, std::slice::from_ref(&all))).trace().max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::least_squares::dot;
    use crate::numerics::random::normal;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;

    /// Columns, blocks and noise of so many rows.
    fn swinging(rows: usize) -> (Vec<Vec<f64>>, Vec<Range<usize>>, Vec<f64>) {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let velocity: Vec<f64> = (0..rows).map(|i| (0.013 * i as f64).sin()).collect();
        let blocks = (0..rows / 100).map(|block| 100 * block..100 * block + 100).collect();
        (law_error_hats(&velocity, None, 1.0), blocks, (0..rows).map(|_| normal(&mut random)).collect())
    }

    #[test]
    fn noise_alone_is_hardly_an_error_and_the_less_so_the_longer() {
        let share = |rows: usize| {
            let (columns, blocks, noise) = swinging(rows);
            let of_noise = dot(&noise, &noise, &blocks);
            [held_out_energy(&columns, &noise, &blocks), curve_variance(&columns, &noise, &blocks)]
                .map(|e| e / of_noise)
        };
        let [short, long] = [2000, 20_000].map(share);
        assert!(short[0] < 0.005 && long[0] < 0.001, "{short:?} {long:?}");
        // The expectation is one row for each of the seventeen coefficients.
        assert!((short[1] * 2000.0 / 17.0 - 1.0).abs() < 0.5 && long[1] < 0.2 * short[1], "{short:?} {long:?}");
    }

    #[test]
    fn a_law_without_an_error_is_as_sure_as_its_rows_are_many() {
        let (_, blocks, noise) = swinging(20_000);
        let velocity: Vec<f64> = (0..20_000).map(|i| 0.3 + 0.2 * f64::from(i).sin()).collect();
        let labels: Vec<usize> = blocks.iter().enumerate().flat_map(|(label, run)| vec![label; run.len()]).collect();
        let error = error_over(&noise, &velocity, None, &labels, 1.0);
        assert!((0.005..0.05).contains(&error), "{error}");
    }

    #[test]
    fn an_error_in_few_rows_comes_out() {
        let (columns, blocks, noise) = swinging(20_000);
        let wrong: Vec<f64> = columns[2].iter().map(|hat| 2.0 * hat).collect();
        let target: Vec<f64> = noise.iter().zip(&wrong).map(|(noise, wrong)| noise + wrong).collect();
        let found = held_out_energy(&columns, &target, &blocks) / dot(&wrong, &wrong, &blocks);
        assert!((0.7..1.1).contains(&found), "{found}");
    }
}
