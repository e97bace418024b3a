//! Constants by trajectory: the joint is simulated under the recorded commands, and actuator, inertia and friction are moved until the
//! simulated positions are the recorded ones. Multiple shooting with states taken from the recording (Bock 1984), damped Gauss-Newton
//! steps (Marquardt 1963), derivatives by central differences of the simulation.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;

use super::commanded::Commanded;
use super::friction::{GearFriction, Terms};
use crate::actuator::{Open, Partial};
use crate::error::Result;
use crate::numerics::statistics::{DEVIATION_PER_MEDIAN, NORMAL_95, quantile};
use crate::rollout::{Body, Rig, State, simulate, starts};

/// Most steps, and the share by which the cost has to fall for another one.
const MOST_STEPS: usize = 40;
const LEAST_GAIN: f64 = 1e-4;
/// A step in which every constant moves less than this share of itself is the last: without noise the cost goes on falling by a share of nothing.
const LEAST_STEP: f64 = 1e-5;
/// Step of the central differences as a share of the size of a constant.
const DIFFERENCE: f64 = 1e-3;
/// The same of the delay, s: commands are held from sample to sample, and a shorter one may change nothing.
const DELAY_DIFFERENCE_S: f64 = 2e-3;
/// Errors of the position count less than squared from this many deviations on: a joint that sticks elsewhere is no noise.
const ROBUST_DEVIATIONS: f64 = 1.5;
/// Errors of the position within this time tell the same, s: from the decay of a joint's own motion.
const CORRELATION_S: f64 = 0.2;

/// Least limit of a torque over the one where the search begins: without torque nothing moves and no constant shows.
const LEAST_LIMIT: f64 = 0.1;

/// A constant that is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Moved {
    pub(super) what: What,
    /// Its size, by which steps are measured.
    scale: f64,
    low: f64,
    high: f64,
}

/// What is moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum What {
    Actuator(Open),
    BackEmf,
    Delay,
    TorqueLimit,
    Inertia,
    Offset,
    /// Of the joint's own gravity torque, of the sine of the position and of the cosine.
    GravitySin,
    GravityCos,
    Coulomb,
    Stribeck,
    StribeckVelocity,
    Viscous,
    Load,
}

/// A joint with values for everything that is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Candidate {
    pub(super) friction: GearFriction,
    /// Inertia of the joint without payload, kg m2.
    pub(super) inertia: f64,
    /// Constant torque, N m.
    pub(super) offset: f64,
    pub(super) gravity: [f64; 2],
    pub(super) open: [Option<f64>; 3],
    /// Loss of a motor by its velocity where coasting shows it, N m s/rad.
    pub(super) back_emf: Option<f64>,
    pub(super) delay_s: f64,
    /// Largest torque of a motor where that is not given, N m.
    pub(super) torque_limit: Option<f64>,
}

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
}

pub(super) fn place(open: Open) -> usize {
    match open {
        Open::Gain => 0,
        Open::Kp => 1,
        Open::Kd => 2,
    }
}

impl Candidate {
    pub(super) fn value(&self, what: What) -> f64 {
        match what {
            What::Actuator(open) => self.open[place(open)].unwrap_or(0.0),
            What::BackEmf => self.back_emf.unwrap_or(0.0),
            What::Delay => self.delay_s,
            What::TorqueLimit => self.torque_limit.unwrap_or(f64::INFINITY),
            What::Inertia => self.inertia,
            What::Offset => self.offset,
            What::GravitySin => self.gravity[0],
            What::GravityCos => self.gravity[1],
            What::Coulomb => self.friction.coulomb,
            What::Stribeck => self.friction.stribeck,
            What::StribeckVelocity => self.friction.stribeck_velocity,
            What::Viscous => self.friction.viscous,
            What::Load => self.friction.load,
        }
    }

    fn with(mut self, what: What, value: f64) -> Self {
        match what {
            What::Actuator(open) => self.open[place(open)] = Some(value),
            What::BackEmf => self.back_emf = Some(value),
            What::Delay => self.delay_s = value,
            What::TorqueLimit => self.torque_limit = Some(value),
            What::Inertia => self.inertia = value,
            What::Offset => self.offset = value,
            What::GravitySin => self.gravity[0] = value,
            What::GravityCos => self.gravity[1] = value,
            What::Coulomb => self.friction.coulomb = value,
            What::Stribeck => self.friction.stribeck = value,
            What::StribeckVelocity => self.friction.stribeck_velocity = value,
            What::Viscous => self.friction.viscous = value,
            What::Load => self.friction.load = value,
        }
        self
    }

    /// The actuator of a recording with this candidate's constants for what is open there.
    pub(super) fn actuator(&self, partial: &Partial) -> Partial {
        let mut complete = partial.clone();
        for open in [Open::Gain, Open::Kp, Open::Kd] {
            if let Some(value) = self.open[place(open)].filter(|_| partial.open.contains(&open)) {
                complete = complete.with(open, value);
            }
        }
        if let Some(back_emf) = self.back_emf {
            complete.actuator.back_emf = back_emf;
        }
        complete.actuator.delay_s = self.delay_s;
        if let Some(limit) = self.torque_limit {
            complete.actuator.limits.torque = limit;
        }
        complete
    }

    /// Simulated states of a recording, begun anew every `window_s`.
    fn states(&self, one: &Commanded<'_>, starts: &[(usize, State)]) -> Result<Vec<State>> {
        let own = Body {
            inertia: self.inertia,
            gravity_sin: self.gravity[0],
            gravity_cos: self.gravity[1],
            offset: self.offset,
        };
        let body = own.with(&one.payload.as_ref().map_or_else(Body::default, Body::of_payload));
        let actuator = self.actuator(&one.partial).actuator;
        let series = one.series_for(&actuator);
        simulate(&Rig { actuator, body }, &series, &mut { self.friction }, starts)
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
    delay_is_open: bool,
) -> Vec<Moved> {
    let positive = |what, scale: f64| Moved { what, scale, low: 0.0, high: f64::INFINITY };
    let mut moved: Vec<Moved> = open
        .iter()
        .map(|open| {
            let value = start.value(What::Actuator(*open)).abs().max(f64::MIN_POSITIVE);
            Moved { what: What::Actuator(*open), scale: value, low: 0.05 * value, high: 20.0 * value }
        })
        .collect();
    moved.extend([
        positive(What::Inertia, start.inertia.abs().max(1e-3 * torque)),
        Moved { what: What::Offset, scale: 0.1 * torque, low: -torque, high: torque },
        positive(What::Coulomb, 0.1 * torque),
    ]);
    if terms.stribeck {
        moved.extend([
            positive(What::Stribeck, 0.1 * torque),
            Moved { what: What::StribeckVelocity, scale: 0.05 * speed, low: 0.005 * speed, high: 0.2 * speed },
        ]);
    }
    moved.push(positive(What::Viscous, 0.1 * torque / speed));
    moved.extend(terms.load.then_some(Moved { what: What::Load, scale: 0.1, low: 0.0, high: 0.95 }));
    moved.extend(
        start.torque_limit.map(|limit| Moved { low: LEAST_LIMIT * limit, ..positive(What::TorqueLimit, limit) }),
    );
    if own_gravity {
        let free = |what| Moved { what, scale: 0.1 * torque, low: f64::NEG_INFINITY, high: f64::INFINITY };
        moved.extend([free(What::GravitySin), free(What::GravityCos)]);
    }
    moved.extend(start.back_emf.map(|_| positive(What::BackEmf, 0.1 * torque / speed)));
    moved.extend(delay_is_open.then_some(Moved { what: What::Delay, scale: 0.01, low: 0.0, high: 0.1 }));
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
    let begun = commanded.iter().map(|one| starts(one.recording, window_s)).collect::<Result<Vec<_>>>()?;
    let errors = |candidate: &Candidate| -> Result<Vec<f64>> {
        let of = |(one, starts): (&Commanded<'_>, &Vec<(usize, State)>)| {
            let states = candidate.states(one, starts)?;
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
    let mut normal = DMatrix::zeros(moved.len(), moved.len());
    for _ in 0..MOST_STEPS {
        let scale = ROBUST_DEVIATIONS * DEVIATION_PER_MEDIAN * quantile(left.iter().map(|x| x.abs()), 0.5);
        let scale = scale.max(f64::MIN_POSITIVE);
        let weights: Vec<f64> = left.iter().map(|x| 1.0 / (1.0 + (x / scale).powi(2)).sqrt()).collect();
        let cost = |left: &[f64]| left.iter().map(|x| (1.0 + (x / scale).powi(2)).sqrt() - 1.0).sum::<f64>();
        let slopes = slopes(&candidate, moved, &errors)?;
        let weighted = |a: &[f64], b: &[f64]| a.iter().zip(b).zip(&weights).map(|((a, b), w)| a * b * w).sum::<f64>();
        normal = DMatrix::from_fn(moved.len(), moved.len(), |i, j| weighted(&slopes[i], &slopes[j]));
        let gradient = DVector::from_fn(moved.len(), |i, _| weighted(&slopes[i], &left));
        let before = cost(&left);
        let mut found = None;
        while damping < 1e8 && found.is_none() {
            let step = step(&normal, &gradient, damping);
            let trial = step.map(|step| stepped(&candidate, moved, &step));
            let tried = trial.and_then(|trial| errors(&trial).ok().map(|left| (trial, left)));
            found = tried.filter(|(_, left)| cost(left) < before);
            damping = if found.is_some() { (0.2 * damping).max(1e-8) } else { 5.0 * damping };
        }
        let Some((trial, tried)) = found else {
            converged = true;
            break;
        };
        let gain = (before - cost(&tried)) / before.max(f64::MIN_POSITIVE);
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
    Ok(Shot { candidate, half_widths: half_widths(&normal, moved, &left, commanded), converged, mae })
}

/// Derivative of every error by every moved constant, per its scale.
fn slopes(
    candidate: &Candidate,
    moved: &[Moved],
    errors: &(impl Fn(&Candidate) -> Result<Vec<f64>> + Sync),
) -> Result<Vec<Vec<f64>>> {
    let slope = |constant: &Moved| {
        let value = candidate.value(constant.what);
        let is_delay = constant.what == What::Delay;
        let step = if is_delay { DELAY_DIFFERENCE_S } else { DIFFERENCE * constant.scale };
        let (low, high) = ((value - step).max(constant.low), (value + step).min(constant.high));
        let (below, above) =
            (errors(&candidate.with(constant.what, low))?, errors(&candidate.with(constant.what, high))?);
        let span = (high - low) / constant.scale;
        Ok(above.iter().zip(&below).map(|(above, below)| (above - below) / span).collect())
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

/// Half of the 95 % intervals, errors within the correlation time counted as one.
fn half_widths(normal: &DMatrix<f64>, moved: &[Moved], left: &[f64], commanded: &[Commanded<'_>]) -> Vec<(What, f64)> {
    let period = commanded.first().and_then(|one| one.recording.health.period_s).unwrap_or(CORRELATION_S);
    let variance =
        left.iter().map(|x| x * x).sum::<f64>() / left.len().max(1) as f64 * (CORRELATION_S / period).max(1.0);
    // What changes nothing takes no part and is not determined.
    let told: Vec<usize> = (0..moved.len()).filter(|&index| normal[(index, index)] > 0.0).collect();
    let covariance = normal.select_rows(&told).select_columns(&told).try_inverse();
    let of = |(index, constant): (usize, &Moved)| {
        let place = told.iter().position(|told| *told == index);
        let own = covariance.as_ref().zip(place);
        let own = own.map_or(f64::INFINITY, |(covariance, place)| covariance[(place, place)].abs());
        (constant.what, NORMAL_95 * constant.scale * (variance * own).sqrt())
    };
    moved.iter().enumerate().map(of).collect()
}
