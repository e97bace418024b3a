//! Whether a recorded velocity is the derivative of the position.

use super::motion::{sigma_s, smooth};
use super::note::{Contradiction, Fault, Note, WrongUnit};
use crate::numerics::filter::gaussian::{GaussianFilter, Order};
use crate::numerics::resolution::resolution;
use crate::recording::{Quantity, Recording};
use crate::samples::VelocitySource;
use std::f64::consts::TAU;

/// Share of the derivative that the grain of the encoder may make up for it to contradict anything.
const MOST_GRAIN: f64 = 0.2;
/// Share of the acceleration's energy that the velocity does not hold, from which a lag can be told from a factor: of a joint that coasts
/// both decline alike.
const LEAST_OWN: f64 = 1e-3;
/// Share of the velocity's energy that derivative and lag have to explain for both to be one motion.
const SAME_MOTION: f64 = 0.8;
/// Factor between them that is no contradiction: filters and calibrations differ by that.
const SAME_UNIT: std::ops::Range<f64> = 0.8..1.25;
/// Change of the velocity within its lag, as a share of the velocity (root mean square), from which a lag matters, and the least lag in
/// periods of the clock.
const MATTERING_LAG: f64 = 0.08;
const LEAST_LAG_PERIODS: f64 = 2.0;
/// Distance of a derivative from a constant velocity, as a share of it (root mean square), from which the motion is not steady.
const UNSTEADY: f64 = 0.1;
/// Factors between units: degrees, turns and revolutions a minute for radians; milli, micro and nano, of time too; and the other way
/// round for a velocity.
const UNIT_FACTORS: [f64; 7] = [360.0 / TAU, TAU, 60.0 / TAU, 6.0, 1e3, 1e6, 1e9];
/// How near to it.
const NEAR: f64 = 0.05;

/// The recording without a velocity that contradicts the position; one in another unit is only noted.
pub(super) fn without_contradiction(recording: &Recording) -> Option<(Option<Recording>, Note)> {
    let fault = contradiction(recording)?;
    let mended = (!fault.is_blocking()).then(|| recording.clone().without(Quantity::Velocity));
    Some((mended, Note::of_all(fault)))
}

fn contradiction(recording: &Recording) -> Option<Fault> {
    let (position, velocity) = (recording.values(Quantity::Position)?, recording.values(Quantity::Velocity)?);
    let moved = smooth(recording, VelocitySource::Derived)?;
    let (derived, acceleration) = (moved.velocity.as_deref()?, moved.acceleration.as_deref()?);
    let smoothed = smooth(recording, VelocitySource::Recorded)?;
    let recorded = smoothed.velocity.as_deref()?;
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let (dd, da, aa) = (dot(derived, derived), dot(derived, acceleration), dot(acceleration, acceleration));
    let (rr, rd, ra) = (dot(recorded, recorded), dot(recorded, derived), dot(recorded, acceleration));
    let period_s = recording.health.period_s?;
    let filter = GaussianFilter::new(sigma_s(recording)?, period_s);
    let grain = resolution(position).unwrap_or(0.0) / 12f64.sqrt() * filter.noise_gain(Order::First);
    let determinant = dd * aa - da * da;
    if grain.powi(2) * derived.len() as f64 > MOST_GRAIN.powi(2) * dd || determinant <= LEAST_OWN * dd * aa {
        return None;
    }
    let contradicts = |how| Some(Fault::ContradictingVelocity(how));
    if velocity.iter().all(|value| *value == velocity[0]) {
        let apart: f64 = derived.iter().map(|derived| (derived - velocity[0]).powi(2)).sum();
        return if apart > UNSTEADY.powi(2) * dd { contradicts(Contradiction::Constant(velocity[0])) } else { None };
    }
    // recorded = factor * (derived - lag * acceleration)
    let factor = (rd * aa - ra * da) / determinant;
    let delayed = -(ra * dd - rd * da) / determinant;
    if factor * rd - delayed * ra < SAME_MOTION * rr {
        return contradicts(Contradiction::Unrelated(rd / (rr * dd).sqrt()));
    }
    if !SAME_UNIT.contains(&factor) {
        let is_unit = |unit: &f64| [*unit, 1.0 / unit].iter().any(|unit| (factor.abs() / unit - 1.0).abs() < NEAR);
        let is_turned = (factor + 1.0).abs() < NEAR;
        return if is_turned || UNIT_FACTORS.iter().any(is_unit) {
            Some(Fault::WrongUnit(WrongUnit::VelocityOverDerivative(factor)))
        } else {
            contradicts(Contradiction::Scaled(factor))
        };
    }
    let lag_s = delayed / factor;
    let matters = lag_s.abs() * (aa / dd).sqrt() > MATTERING_LAG && lag_s.abs() > LEAST_LAG_PERIODS * period_s;
    if matters { contradicts(Contradiction::Late(lag_s)) } else { None }
}
