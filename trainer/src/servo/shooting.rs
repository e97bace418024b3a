//! Constants by trajectory: the joint is simulated under the recorded commands, and actuator, inertia and friction are moved until the
//! simulated positions are the recorded ones. Multiple shooting with states taken from the recording (Bock 1984), damped Gauss-Newton
//! steps (Marquardt 1963), derivatives by the simulation itself in dual numbers.

use nalgebra::{DMatrix, DVector};
use num_dual::Dual64;
use rayon::prelude::*;

use super::candidate::{Candidate, What};
use super::commanded::Commanded;
use super::intervals::{Linearised, independent_variance};
use super::moved::{Moved, Starts};
use crate::error::Result;
use crate::numerics::statistics::{DEVIATION_PER_MEDIAN, NORMAL_95, quantile};
use crate::rollout::{State, starts};

/// Most steps, a limit of the computing time, and the share by which the cost has to fall for another one.
const MOST_STEPS: usize = 100;
const LEAST_GAIN: f64 = 1e-4;
/// A step in which every constant moves less than this share of itself is the last: without noise the cost goes on falling by a share of nothing.
const LEAST_STEP: f64 = 1e-5;
/// Errors of the position count less than squared from this many deviations on: a joint that sticks elsewhere is no noise.
const ROBUST_DEVIATIONS: f64 = 1.5;

/// A constant whose interval is more than this share of what was known of it before is not determined by the recordings.
const LEARNED_SHARE: f64 = 0.5;

/// Where shooting ended.
#[derive(Clone, Debug)]
pub(super) struct Shot {
    pub(super) candidate: Candidate,
    /// Half of the 95 % interval of each moved constant.
    pub(super) half_widths: Vec<(What, f64)>,
    pub(super) converged: bool,
    /// Mean absolute error of the position, rad.
    pub(super) mae: f64,
}

impl Shot {
    /// A limit that the torque stays below changes nothing and is none.
    pub(super) fn forget_unreached_limit(&mut self) {
        let is_unreached = |(what, half): &(What, f64)| *what == What::TorqueLimit && !half.is_finite();
        if self.half_widths.iter().any(is_unreached) {
            self.candidate.torque_limit = None;
            self.half_widths.retain(|told| !is_unreached(told));
        }
    }

    /// A constant of which the recordings say no more than was known before is not told.
    pub(super) fn forget_unlearned(&mut self, moved: &[Moved]) {
        self.half_widths.retain(|(what, half)| {
            let prior = moved.iter().find(|constant| constant.what == *what).and_then(|constant| constant.prior);
            prior.is_none_or(|(_, deviation)| *half < LEARNED_SHARE * NORMAL_95 * deviation)
        });
    }
}

/// Moves the constants from `start` on until the simulated positions are the recorded ones, begun anew every `window_s`.
///
/// # Errors
/// `FRK-N004` where the start itself cannot be simulated.
pub(super) fn shoot(
    commanded: &[Commanded<'_>],
    start: Candidate,
    moved: &[Moved],
    window_s: Option<f64>,
) -> Result<Shot> {
    let begun: Starts = commanded.iter().map(|one| starts(one.recording, window_s)).collect::<Result<_>>()?;
    let errors = |candidate: &Candidate| -> Result<Vec<f64>> {
        let of = |(one, starts): (&Commanded<'_>, &Vec<(usize, State)>)| {
            let states = candidate.states(one, &one.series, starts)?;
            Ok(states
                .iter()
                .zip(one.positions())
                .map(|(state, position)| state.position - position)
                .collect::<Vec<f64>>())
        };
        Ok(commanded.iter().zip(&begun).map(of).collect::<Result<Vec<_>>>()?.concat())
    };
    let mut candidate = start;
    let mut left = errors(&candidate)?;
    let mut damping = 1e-2;
    let mut converged = false;
    let mut linearised = None;
    for _ in 0..MOST_STEPS {
        let scale = ROBUST_DEVIATIONS * DEVIATION_PER_MEDIAN * quantile(left.iter().map(|x| x.abs()), 0.5);
        let scale = scale.max(f64::MIN_POSITIVE);
        let weights: Vec<f64> = left.iter().map(|x| 1.0 / (1.0 + (x / scale).powi(2)).sqrt()).collect();
        let independent = independent_variance(&left, commanded);
        let cost = |candidate: &Candidate, left: &[f64]| {
            let of_errors = left.iter().map(|x| (1.0 + (x / scale).powi(2)).sqrt() - 1.0).sum::<f64>();
            let of_prior: f64 = moved.iter().map(|constant| constant.beside_prior(candidate).powi(2)).sum();
            of_errors + 0.5 * independent / (scale * scale) * of_prior
        };
        let slopes = slopes(&candidate, moved, commanded, &begun)?;
        let count = moved.len();
        let mut at = Linearised { normal: DMatrix::zeros(count, count), slopes, weights };
        at.normal = DMatrix::from_fn(count, count, |i, j| at.along(i, &at.slopes[j]));
        let mut gradient = DVector::from_fn(count, |i, _| at.along(i, &left));
        for (i, constant) in moved.iter().enumerate() {
            let per_scale = constant.prior.map_or(0.0, |(_, deviation)| constant.scale / deviation);
            at.normal[(i, i)] += independent * per_scale * per_scale;
            gradient[i] += independent * per_scale * constant.beside_prior(&candidate);
        }
        let at = linearised.insert(at);
        // A constant at a bound that would go beyond it stays there, and the others move without it.
        let is_free = |i: &usize| {
            let (constant, value) = (&moved[*i], candidate.value(moved[*i].what));
            !(value <= constant.low && gradient[*i] > 0.0 || value >= constant.high && gradient[*i] < 0.0)
        };
        let free: Vec<usize> = (0..count).filter(is_free).collect();
        let before = cost(&candidate, &left);
        let mut found = None;
        while damping < 1e8 && found.is_none() {
            let step = step(&at.normal, &gradient, damping, &free);
            let trial = step.map(|step| stepped(&candidate, moved, &step));
            let tried = trial.and_then(|trial| errors(&trial).ok().map(|left| (trial, left)));
            found = tried.filter(|(trial, left)| cost(trial, left) < before);
            damping = if found.is_some() { (0.2 * damping).max(1e-8) } else { 5.0 * damping };
        }
        let Some((trial, tried)) = found else {
            converged = true;
            break;
        };
        let gain = (before - cost(&trial, &tried)) / before.max(f64::MIN_POSITIVE);
        let rests = moved.iter().all(|constant| {
            let (from, to) = (candidate.value(constant.what), trial.value(constant.what));
            (to - from).abs() <= LEAST_STEP * to.abs().max(constant.scale)
        });
        (candidate, left) = (trial, tried);
        if gain < LEAST_GAIN || rests {
            converged = true;
            break;
        }
    }
    let mae = left.iter().map(|x| x.abs()).sum::<f64>() / left.len().max(1) as f64;
    let half_widths = match linearised {
        Some(at) => at.half_widths(moved, (&candidate, &left), commanded, &begun),
        None => Vec::new(),
    };
    Ok(Shot { candidate, half_widths, converged, mae })
}

/// Derivative of every simulated position by every moved constant, per its scale.
fn slopes(
    candidate: &Candidate,
    moved: &[Moved],
    commanded: &[Commanded<'_>],
    begun: &Starts,
) -> Result<Vec<Vec<f64>>> {
    let slope = |constant: &Moved| {
        let value = Dual64::new(candidate.value(constant.what), constant.scale);
        let moving = candidate.lifted().with(constant.what, value);
        let mut slopes = Vec::new();
        for (one, starts) in commanded.iter().zip(begun) {
            slopes.extend(moving.states(one, &one.series, starts)?.iter().map(|state| state.position.eps));
        }
        Ok(slopes)
    };
    moved.par_iter().map(slope).collect::<Vec<Result<Vec<f64>>>>().into_iter().collect()
}

/// The damped step of the constants that are free, zero of the others.
fn step(normal: &DMatrix<f64>, gradient: &DVector<f64>, damping: f64, free: &[usize]) -> Option<DVector<f64>> {
    let mut damped = normal.select_rows(free).select_columns(free);
    let largest = normal.diagonal().max();
    for (i, place) in free.iter().enumerate() {
        damped[(i, i)] += damping * normal[(*place, *place)].max(1e-9 * largest);
    }
    let solved = damped.cholesky()?.solve(&gradient.select_rows(free));
    let mut step = DVector::zeros(gradient.len());
    free.iter().zip(solved.iter()).for_each(|(place, own)| step[*place] = *own);
    Some(step)
}

fn stepped(candidate: &Candidate, moved: &[Moved], step: &DVector<f64>) -> Candidate {
    moved.iter().zip(step.iter()).fold(*candidate, |at, (constant, step)| {
        let value = at.value(constant.what) - constant.scale * step;
        at.with(constant.what, value.clamp(constant.low, constant.high))
    })
}
