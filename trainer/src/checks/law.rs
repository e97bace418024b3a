//! The law that any joint obeys in the first place, linear in its parameters: inertia, gravity or another function of the position,
//! Coulomb and viscous friction, offset, a given rigid body and the couplings with recorded joints. Checks ask it what the torque
//! should be; it is no model of anything.

use super::motion::{top_speed, torque};
use crate::numerics::filter::gaussian::{GaussianFilter, Order};
use crate::numerics::least_squares::weighted;
use crate::numerics::regression::{LinearFit, least_squares};
use crate::numerics::statistics::mean;
use crate::recording::{Axis, Quantity};
use crate::samples::Samples;
use std::ops::Range;

/// Share of the top speed over which the Coulomb torque turns.
const TURNING_SHARE: f64 = 0.02;
/// Share of the top speed below which a sample is left out of the fit: at a reversal the filter blurs friction, and friction is no
/// function of the velocity.
const MOVING_SHARE: f64 = 0.1;
/// Blocks whose scatter gives the standard errors.
const BLOCKS: usize = 40;
/// Most couplings that are taken.
const MOST_COUPLINGS: usize = 4;

/// How the torque depends on the position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum PositionTerms {
    /// As gravity does, `sin(scale q)` and `cos(scale q)`; `scale` is 1 for radians.
    Gravity(f64),
    /// As a quadratic: whatever is smooth.
    Quadratic,
}

/// Columns of the law, one value a sample, and what each is.
#[derive(Clone, Debug)]
pub(super) struct Columns {
    pub(super) values: Vec<Vec<f64>>,
    pub(super) coulomb: usize,
    pub(super) viscous: usize,
    pub(super) inertia: Option<usize>,
    /// The recorded rigid body.
    pub(super) body: Option<usize>,
    /// Sine and cosine of the position.
    pub(super) gravity: Option<[usize; 2]>,
    /// Accelerations of other joints.
    pub(super) couplings: Range<usize>,
}

/// The law fitted to the samples that move.
pub(super) struct Law {
    pub(super) columns: Columns,
    pub(super) fit: LinearFit,
    /// Share of the variance of the torque that it explains.
    pub(super) explained: f64,
}

impl Columns {
    /// The columns at samples with a velocity; `top_speed` (rad/s or m/s) scales the turning of the Coulomb torque.
    pub(super) fn of(samples: &Samples, top_speed: f64, position: PositionTerms) -> Option<Self> {
        let velocity = samples.velocity.as_deref()?;
        let sign = velocity.iter().map(|v| (v / (TURNING_SHARE * top_speed)).tanh()).collect();
        let mut values = vec![sign, velocity.to_vec(), vec![1.0; velocity.len()]];
        let mut push = |column: Vec<f64>| {
            values.push(column);
            values.len() - 1
        };
        // Friction that was separated holds nothing else.
        let with_body = samples.friction.is_none();
        let inertia =
            samples.acceleration.as_ref().filter(|_| with_body).map(|acceleration| push(acceleration.clone()));
        let body = samples.rigid_body.as_ref().filter(|_| with_body).map(|body| push(body.clone()));
        let mut gravity = None;
        if let Some(q) = samples.position.as_ref().filter(|_| with_body) {
            let of = |function: &dyn Fn(f64) -> f64| q.iter().map(|q| function(*q)).collect::<Vec<f64>>();
            match position {
                PositionTerms::Gravity(scale) if samples.axis == Axis::Rotary => {
                    gravity = Some([push(of(&|q| (scale * q).sin())), push(of(&|q| (scale * q).cos()))]);
                }
                _ => {
                    push(of(&|q| q));
                    push(of(&|q| q * q));
                }
            }
        }
        let begin = values.len();
        values.extend(couplings(samples));
        let couplings = begin..values.len();
        Some(Self { values, coulomb: 0, viscous: 1, inertia, body, gravity, couplings })
    }

    /// Least squares of the torque of the same samples, those in motion.
    pub(super) fn fit(self, samples: &Samples, top_speed: f64) -> Option<Law> {
        let rows = moving(samples.velocity.as_deref()?, top_speed);
        let pick = |series: &[f64]| rows.iter().map(|row| series[*row]).collect::<Vec<f64>>();
        let columns: Vec<Vec<f64>> = self.values.iter().map(|column| pick(column)).collect();
        let torque = pick(torque(samples)?);
        let block = |index: usize| index * rows.len() / BLOCKS..(index + 1) * rows.len() / BLOCKS;
        let blocks: Vec<Range<usize>> = (0..BLOCKS).map(block).collect();
        let fit = least_squares(&columns, &torque, &blocks);
        let centre = mean(&torque);
        let spread = mean(&torque.iter().map(|value| (value - centre).powi(2)).collect::<Vec<f64>>());
        let explained = if spread > 0.0 { 1.0 - fit.rmse.powi(2) / spread } else { 0.0 };
        Some(Law { columns: self, fit, explained })
    }

    /// What coefficients make of these columns at every sample.
    pub(super) fn predict(&self, coefficients: &[f64]) -> Vec<f64> {
        weighted(&self.values, coefficients)
    }
}

impl Law {
    /// The law over radians, or metres.
    pub(super) fn of(samples: &Samples) -> Option<Self> {
        let top = top_speed(samples.velocity.as_deref()?);
        Columns::of(samples, top, PositionTerms::Gravity(1.0))?.fit(samples, top)
    }
}

/// Samples in motion.
pub(super) fn moving(velocity: &[f64], top_speed: f64) -> Vec<usize> {
    (0..velocity.len()).filter(|row| velocity[*row].abs() > MOVING_SHARE * top_speed).collect()
}

/// Accelerations of other joints whose positions are recorded beside this one's: what inertia couples.
fn couplings(samples: &Samples) -> Vec<Vec<f64>> {
    let Some(rate_hz) = samples.rate_hz else { return Vec::new() };
    let filter = GaussianFilter::new(0.0, 1.0 / rate_hz);
    let is_position = |name: &str| {
        let rest = name.split_once('_').map_or("", |(_, rest)| rest);
        matches!(Quantity::of_column(rest), Some((Quantity::Position, _)))
    };
    let acceleration = |values: &[f64]| {
        let of_segment = |segment: &Range<usize>| filter.apply_everywhere(&values[segment.clone()], Order::Second);
        samples.segments.iter().flat_map(of_segment).collect()
    };
    let named = samples.channels.iter().filter(|(name, _)| is_position(name));
    named.take(MOST_COUPLINGS).map(|(_, values)| acceleration(values)).collect()
}
