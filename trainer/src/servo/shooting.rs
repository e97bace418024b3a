//! Constants by trajectory: the joint is simulated under the recorded commands, and actuator, inertia and friction are moved until the
//! simulated positions are the recorded ones. Multiple shooting with states taken from the recording (Bock 1984), damped Gauss-Newton
//! steps (Marquardt 1963), derivatives by the simulation itself in dual numbers.

use nalgebra::{DMatrix, DVector};
use num_dual::Dual64;
use rayon::prelude::*;

use super::candidate::{Candidate, What};
use super::commanded::Commanded;
use super::friction::Terms;
use super::intervals::{Linearised, independent_variance};
use crate::actuator::Open;
use crate::error::Result;
use crate::numerics::statistics::{DEVIATION_PER_MEDIAN, NORMAL_95, quantile};
use crate::rollout::{State, starts};

/// Most steps, and the share by which the cost has to fall for another one.
const MOST_STEPS: usize = 100;
const LEAST_GAIN: f64 = 1e-4;
/// A step in which every constant moves less than this share of itself is the last: without noise the cost goes on falling by a share of nothing.
const LEAST_STEP: f64 = 1e-5;
/// Errors of the position count less than squared from this many deviations on: a joint that sticks elsewhere is no noise.
const ROBUST_DEVIATIONS: f64 = 1.5;

/// How late a controller sees the motion where nobody says it, s: a half-normal deviation. Drives close such loops at 1 to 20 kHz and act on a motion of
/// a period and a half before (Franklin, Powell & Workman 1998), which is 0.08 to 1.5 ms.
const FEEDBACK_DELAY_S: f64 = 0.5e-3;
/// A constant whose interval is more than this share of what was known of it before is not determined by the recordings.
const LEARNED_SHARE: f64 = 0.5;

/// Least limit of a torque over the one where the search begins: without torque nothing moves and no constant shows.
const LEAST_LIMIT: f64 = 0.1;

/// A constant that is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Moved {
    pub(super) what: What,
    /// Its size, by which steps are measured.
    pub(super) scale: f64,
    low: f64,
    high: f64,
    /// Mean and deviation of what is known of it before.
    prior: Option<(f64, f64)>,
}

impl Moved {
    fn between(what: What, scale: f64, low: f64, high: f64) -> Self {
        Self { what, scale, low, high, prior: None }
    }

    /// How many deviations a candidate is from what was known before.
    fn beside_prior(&self, candidate: &Candidate) -> f64 {
        self.prior.map_or(0.0, |(mean, deviation)| (candidate.value(self.what) - mean) / deviation)
    }
}

/// Rows of each recording from which its recorded state is taken, with that state.
pub(super) type Starts = Vec<Vec<(usize, State)>>;

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

/// Constants that are moved from a start on, with their bounds; the joint's own gravity where that is not the payload's alone. The loss by
/// back-EMF of a motor of which nothing else is known is part of the viscous friction. Friction that falls over more than a fifth of the top speed
/// would be Coulomb and viscous friction under other names.
pub(super) fn moved(
    start: &Candidate,
    open: &[Open],
    [torque, speed]: [f64; 2],
    terms: Terms,
    own_gravity: bool,
    [delay_is_open, feedback_delay_is_open]: [bool; 2],
) -> Vec<Moved> {
    let positive = |what, scale: f64| Moved::between(what, scale, 0.0, f64::INFINITY);
    let mut moved: Vec<Moved> = open
        .iter()
        .map(|open| {
            let value = start.value(What::Actuator(*open)).abs().max(f64::MIN_POSITIVE);
            Moved::between(What::Actuator(*open), value, 0.05 * value, 20.0 * value)
        })
        .collect();
    moved.extend([
        positive(What::Inertia, start.inertia.abs().max(1e-3 * torque)),
        Moved::between(What::Offset, 0.1 * torque, -torque, torque),
        positive(What::Coulomb, 0.1 * torque),
    ]);
    if terms.stribeck {
        moved.extend([
            positive(What::Stribeck, 0.1 * torque),
            Moved::between(What::StribeckVelocity, 0.05 * speed, 0.005 * speed, 0.2 * speed),
        ]);
    }
    moved.push(positive(What::Viscous, 0.1 * torque / speed));
    moved.extend(terms.load.then_some(Moved::between(What::Load, 0.1, 0.0, 0.95)));
    moved.extend(
        start.torque_limit.map(|limit| Moved { low: LEAST_LIMIT * limit, ..positive(What::TorqueLimit, limit) }),
    );
    if own_gravity {
        let free = |what| Moved::between(what, 0.1 * torque, f64::NEG_INFINITY, f64::INFINITY);
        moved.extend([free(What::GravitySin), free(What::GravityCos)]);
    }
    moved.extend(start.back_emf.map(|_| positive(What::BackEmf, 0.1 * torque / speed)));
    moved.extend(delay_is_open.then_some(Moved::between(What::Delay, 0.01, 0.0, 0.1)));
    // Of a feedback that is late the gains take viscous friction and inertia: kp and kd times the delay (first order).
    moved.extend(feedback_delay_is_open.then(|| Moved {
        prior: Some((start.feedback_delay_s, FEEDBACK_DELAY_S)),
        ..Moved::between(What::FeedbackDelay, FEEDBACK_DELAY_S, 0.0, 0.1)
    }));
    moved
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
        let before = cost(&candidate, &left);
        let mut found = None;
        while damping < 1e8 && found.is_none() {
            let step = step(&at.normal, &gradient, damping);
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
        Some(at) => at.half_widths(moved, (&candidate, &left), commanded, &begun)?,
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

fn step(normal: &DMatrix<f64>, gradient: &DVector<f64>, damping: f64) -> Option<DVector<f64>> {
    let mut damped = normal.clone();
    let largest = normal.diagonal().max();
    for i in 0..damped.nrows() {
        damped[(i, i)] += damping * normal[(i, i)].max(1e-9 * largest);
    }
    damped.cholesky().map(|factor| factor.solve(gradient))
}

fn stepped(candidate: &Candidate, moved: &[Moved], step: &DVector<f64>) -> Candidate {
    moved.iter().zip(step.iter()).fold(*candidate, |at, (constant, step)| {
        let value = at.value(constant.what) - constant.scale * step;
        at.with(constant.what, value.clamp(constant.low, constant.high))
    })
}
