//! The motion and the torque of a recording behind one slow filter: what checks compare. Slower than a fit would take, since a unit
//! or a sign shows in the slow motion already and the encoder's grain does not.

use crate::numerics::statistics::{mean, quantile, root_mean_square};
use crate::recording::{Quantity, Recording};
use crate::samples::spikes::without_spikes;
use crate::samples::{Preparation, Samples, VelocitySource, prepare};

/// Standard deviation of the filter as a share of the time scale of the motion, rms(position) / rms(velocity): a swing of one frequency
/// keeps 99.9 %.
const MOTION_SHARE: f64 = 0.04;
/// Bounds of it: s, and rows.
const LONGEST_S: f64 = 0.02;
const FEWEST_ROWS: f64 = 2.0;
/// Rows over which the speed is taken before there is a filter.
const REACH: usize = 10;
/// Fewest samples that tell anything.
const FEWEST_SAMPLES: usize = 100;

/// Samples a standard deviation of the filter apart; `None` without clock or position, or where too few are left.
pub(super) fn smooth(recording: &Recording, velocity: VelocitySource) -> Option<Samples> {
    let sigma_s = sigma_s(recording)?;
    let preparation = Preparation {
        sigma_s: Some(sigma_s),
        rate_hz: Some(1.0 / sigma_s),
        velocity,
        acceleration_noise: 0.0,
        torque_delay_s: 0.0,
    };
    let (recording, _) = without_spikes(recording);
    let samples = prepare(&recording, &preparation).ok()?;
    (samples.len() >= FEWEST_SAMPLES).then_some(samples)
}

/// Standard deviation of the filter, s.
pub(super) fn sigma_s(recording: &Recording) -> Option<f64> {
    let (time, position) = (recording.values(Quantity::Time)?, recording.values(Quantity::Position)?);
    let speeds: Vec<f64> = (REACH..time.len())
        .map(|row| (position[row] - position[row - REACH]) / (time[row] - time[row - REACH]))
        .collect();
    let centre = mean(position);
    let centred: Vec<f64> = position.iter().map(|value| value - centre).collect();
    let scale_s = root_mean_square(&centred) / root_mean_square(&speeds);
    let shortest = FEWEST_ROWS * recording.health.period_s?;
    (scale_s.is_finite() && scale_s > 0.0).then(|| (MOTION_SHARE * scale_s).min(LONGEST_S).max(shortest))
}

/// The speed that is exceeded rarely: the scale of the motion.
pub(super) fn top_speed(velocity: &[f64]) -> f64 {
    quantile(velocity.iter().map(|v| v.abs()), 0.98)
}

/// The torque, force or current of samples, or the friction where it is recorded separated.
pub(super) fn torque(samples: &Samples) -> Option<&[f64]> {
    samples.friction.as_deref().or(samples.actuator.as_deref())
}
