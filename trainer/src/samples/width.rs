//! Width of the filter and source of the velocity.
//!
//! For a prediction, and of two sources of the velocity, the one counts that leaves least of the actuator as recorded: noise of the acceleration that
//! a narrow filter lets through, and motion that a wide one takes away, both stand in that. Inertia, gravity and friction are identified anew at
//! every width, on other blocks than those that are scored.
//!
//! For learning the error of the constants counts. It falls with the width as long as noise of the position makes it, which scatters them and takes
//! part of the inertia (errors in variables; Fuller 1987), and then stays: torque and states pass the same filter.

use nalgebra::DMatrix;
use rayon::prelude::*;

use super::prepare::prepare;
use super::rigid_body;
use super::rigid_body::Term;
use super::{BendingLaw, Preparation, SLIDING_SPEED_SHARE, Samples, top_speed};
use crate::error::{Error, Result, codes};
use crate::joint::Joint;
use crate::numerics::jackknife::{ERROR_BLOCKS, even_blocks};
use crate::numerics::products::{dot, norm};
use crate::numerics::regression::{Columns, least_squares};
use crate::recording::Recording;

/// Factor from one width to the next.
pub(crate) const STEP: f64 = std::f64::consts::SQRT_2;
/// Most samples of all recordings together at which one width is scored.
const MOST_SAMPLES: f64 = 30_000.0;
/// Blocks of each recording, every other of which is held out in turn.
const BLOCKS: usize = 20;
/// Another step has to bring the mean square error of the constants down by this factor. The power of the acceleration's noise falls by
/// [`STEP`]^5 = 5.7 a step, so that it has an eighth of the error at most where a step brings less.
const LEAST_GAIN: f64 = 1.1;
/// Share of an acceleration's power beside the other columns that may be its noise: beyond half, nothing is known of the inertia.
const MOST_NOISE_SHARE: f64 = 0.5;
/// Where the smoothed signs of the velocity have three quarters of their height, as shares of the top speed: sharp as
/// Coulomb friction, and wide as what a Stribeck curve adds to it.
const SIGN_WIDTHS: [f64; 2] = [0.02, 0.1];

/// One preparation with what it leaves.
#[derive(Clone, Debug)]
pub(super) struct Trial {
    pub(super) preparation: Preparation,
    /// Mean square of what is left of the recorded torque, a block; `None` where the block has no samples.
    blocks: Vec<Option<f64>>,
    /// Expected mean square, over samples that slide, of what errors of the constants make of the torque.
    error: f64,
}

/// Left of the recorded actuator at every sample, and the expected mean square of what errors of the constants make of the torque.
pub(super) type Residual<'a> = dyn Fn(&Samples, &Preparation) -> Result<(Vec<f64>, f64)> + Sync + 'a;

/// Widths from `shortest` to `longest`, s.
pub(super) fn ladder(shortest: f64, longest: f64) -> Vec<f64> {
    let steps = (longest / shortest).max(1.0).log(STEP) + 1e-9;
    (0..=steps as i32).map(|k| shortest * STEP.powi(k)).collect()
}

/// Tries every preparation that the recordings are long enough for.
pub(super) fn trials(recordings: &[&Recording], preparations: &[Preparation], residual: &Residual<'_>) -> Vec<Trial> {
    let tried = preparations.par_iter().map(|preparation| {
        let parts: Result<Vec<Samples>> =
            recordings.iter().map(|r| prepare(r, &thinned(recordings, preparation, MOST_SAMPLES))).collect();
        let samples = parts.and_then(Samples::join).ok()?;
        let (left, error) = residual(&samples, preparation).ok()?;
        let blocks = block_means(&samples, &left);
        Some(Trial { preparation: *preparation, blocks, error })
    });
    tried.collect::<Vec<_>>().into_iter().flatten().collect()
}

/// The same filter with `most` samples of all recordings together at most: filtered where they are taken, not at every row.
pub(crate) fn thinned(recordings: &[&Recording], preparation: &Preparation, most: f64) -> Preparation {
    let span = |recording: &&Recording| {
        let time = recording.values(crate::recording::Quantity::Time)?;
        Some(time.last()? - time.first()?)
    };
    let seconds: f64 = recordings.iter().filter_map(span).sum();
    let most = most / seconds.max(f64::MIN_POSITIVE);
    Preparation { rate_hz: Some(preparation.rate_hz.map_or(most, |rate| rate.min(most))), ..*preparation }
}

fn block_means(samples: &Samples, left: &[f64]) -> Vec<Option<f64>> {
    let mut sums = vec![(0.0, 0.0); BLOCKS * samples.recordings.len()];
    for (row, block) in block_of_rows(samples).into_iter().enumerate() {
        sums[block].0 += left[row] * left[row];
        sums[block].1 += 1.0;
    }
    sums.into_iter().map(|(sum, count)| (count > 0.0).then_some(sum / count)).collect()
}

/// Block of every sample: equal spans of time of each recording, the same whatever the filter takes off its ends.
fn block_of_rows(samples: &Samples) -> Vec<usize> {
    let mut blocks = Vec::with_capacity(samples.len());
    for (index, (_, rows)) in samples.recordings.iter().enumerate() {
        let time = &samples.time[rows.clone()];
        let (first, last) = (time.first().copied().unwrap_or(0.0), time.last().copied().unwrap_or(0.0));
        let length = (last - first).max(f64::MIN_POSITIVE) / BLOCKS as f64;
        let place = |t: &f64| BLOCKS * index + (((t - first) / length) as usize).min(BLOCKS - 1);
        blocks.extend(time.iter().map(place));
    }
    blocks
}

impl Trial {
    /// Mean square over blocks.
    pub(super) fn mean_square(&self) -> f64 {
        let (sum, count) = self.blocks.iter().flatten().fold((0.0, 0.0), |(s, n), square| (s + square, n + 1.0));
        if count > 0.0 { sum / count } else { f64::INFINITY }
    }
}

/// The trial that leaves least.
pub(super) fn best(trials: &[Trial]) -> Option<&Trial> {
    trials.iter().min_by(|a, b| a.mean_square().total_cmp(&b.mean_square()))
}

/// The width to learn at, from the source of velocity that leaves least: the shortest at which noise has little part in the error of the constants.
/// A wider one would know them no better, and what a joint does that sticks for a moment is no average of its law over the states of a sample.
pub(super) fn to_learn_at(trials: &[Trial]) -> Option<&Trial> {
    let source = best(trials)?.preparation.velocity;
    let of_its_source: Vec<&Trial> = trials.iter().filter(|trial| trial.preparation.velocity == source).collect();
    let rests = |pair: &&[&Trial]| pair[0].error.is_finite() && pair[0].error <= LEAST_GAIN * pair[1].error;
    let rests = of_its_source.windows(2).find(rests);
    rests.map(|pair| pair[0]).or(of_its_source.last().copied())
}

/// What rigid body and friction leave of the recorded actuator, identified on the even blocks for the odd ones and the other
/// way round; and the error of the constants.
///
/// # Errors
/// `FRK-D009` where neither actuator nor friction is recorded.
pub(super) fn cross_fitted(samples: &Samples, joint: &Joint, acceleration_noise: f64) -> Result<(Vec<f64>, f64)> {
    let not_recorded = || Error::new(&codes::MISSING_COLUMN, "neither actuator nor friction is recorded");
    let recorded = samples.recorded.as_deref().ok_or_else(not_recorded)?;
    let (given, mut terms) = match samples.friction {
        Some(_) => (vec![0.0; samples.len()], Vec::new()),
        None => (rigid_body::given_torque(samples, joint)?, rigid_body::terms(samples, joint)),
    };
    let filtered = samples.friction.as_deref().or(samples.actuator.as_deref()).unwrap_or_default();
    terms.retain(|term| term.kind != rigid_body::TermKind::TorqueOffset);
    let target: Vec<f64> = filtered.iter().zip(&given).map(|(torque, given)| torque - given).collect();
    let error = error_of_constants(samples, &terms, &target, acceleration_noise)?;
    let mut columns: Vec<Vec<f64>> = terms.into_iter().map(|term| term.column).collect();
    columns.extend(smooth_friction_columns(samples.require_velocity()?));
    let blocks = block_of_rows(samples);
    let mut left = vec![0.0; samples.len()];
    for held in 0..2 {
        let learnt: Vec<usize> = (0..samples.len()).filter(|&row| blocks[row] % 2 != held).collect();
        let pick = |column: &[f64]| learnt.iter().map(|&row| column[row]).collect::<Vec<f64>>();
        let own: Vec<Vec<f64>> = columns.iter().map(|column| pick(column)).collect();
        let whole = std::iter::once(0..learnt.len()).collect::<Vec<_>>();
        let fit = least_squares(&own, &pick(&target), &whole);
        for row in (0..samples.len()).filter(|&row| blocks[row] % 2 == held) {
            let predicted: f64 = columns.iter().zip(&fit.coefficients).map(|(column, c)| c * column[row]).sum();
            left[row] = recorded[row] - given[row] - predicted;
        }
    }
    Ok((left, error))
}

/// Expected mean square, over the samples that slide, of what errors of rigid body and friction make of the torque: the scatter of the
/// constants from block to block, and what noise of the acceleration takes of the inertia (errors in variables; Fuller 1987).
fn error_of_constants(samples: &Samples, terms: &[Term], target: &[f64], acceleration_noise: f64) -> Result<f64> {
    let velocity = samples.require_velocity()?;
    let sliding = SLIDING_SPEED_SHARE * top_speed(velocity);
    let rows: Vec<usize> = (0..velocity.len()).filter(|&row| velocity[row].abs() > sliding).collect();
    let pick = |column: &[f64]| rows.iter().map(|&row| column[row]).collect::<Vec<f64>>();
    let velocity = pick(velocity);
    let mut columns: Vec<Vec<f64>> = terms.iter().map(|term| pick(&term.column)).collect();
    columns.extend(BendingLaw::over(&velocity)?.columns(&velocity));
    let fit = least_squares(&columns, &pick(target), &even_blocks(rows.len(), ERROR_BLOCKS));
    let gram = DMatrix::from_fn(columns.len(), columns.len(), |i, j| dot(&columns[i], &columns[j]) / rows.len() as f64);
    let scatter = (&gram * &fit.covariance).trace();
    let Some(inertia) = terms.iter().position(|term| term.kind.is_inertia()) else { return Ok(scatter) };
    let others: Vec<Vec<f64>> =
        columns.iter().enumerate().filter(|(i, _)| *i != inertia).map(|(_, c)| c.clone()).collect();
    let own = Columns::of(&others).residuals(&columns[inertia]);
    let power = dot(&own, &own) / rows.len() as f64;
    let share = acceleration_noise.powi(2) / power.max(f64::MIN_POSITIVE);
    if share > MOST_NOISE_SHARE {
        return Ok(f64::INFINITY);
    }
    let missing = fit.coefficients[inertia] * share / (1.0 - share);
    Ok(scatter + missing * missing * (1.0 - share) * power)
}

/// Friction over velocity as a few smooth shapes that serve at any width: signs, viscous, their asymmetries, a constant.
pub(crate) fn smooth_friction_columns(velocity: &[f64]) -> Vec<Vec<f64>> {
    let top = top_speed(velocity).max(f64::MIN_POSITIVE);
    let mut columns: Vec<Vec<f64>> =
        SIGN_WIDTHS.iter().map(|width| velocity.iter().map(|v| (v / (width * top)).tanh()).collect()).collect();
    columns.push(velocity.to_vec());
    columns.push(velocity.iter().map(|v| v.abs()).collect());
    columns.push(vec![1.0; velocity.len()]);
    columns.retain(|column| norm(column) > 0.0);
    columns
}
