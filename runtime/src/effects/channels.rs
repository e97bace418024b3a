//! Terms of another channel: temperature and load.

use frikan_shared::effect::Effect;
use frikan_shared::elementary::exp;

use super::Motion;

/// Torque of a channel term; 0 for any other effect.
#[must_use]
pub fn torque(effect: &Effect, motion: &Motion) -> f32 {
    match *effect {
        Effect::Temperature { reference, coulomb, viscous, smoothing_velocity } => {
            let slope = coulomb * motion.smooth_sign(smoothing_velocity) + viscous * motion.velocity;
            slope * (motion.temperature - reference)
        }
        Effect::Load { mean, difference, quadratic, stribeck, velocity, smoothing_velocity } => {
            let sign = motion.smooth_sign(smoothing_velocity);
            let load = motion.load;
            let ratio = motion.velocity / velocity;
            let rise = 1.0 + stribeck * exp(-(ratio * ratio));
            (mean * load.abs() * sign + difference * load * sign.abs()) * rise + quadratic * load * load * sign
        }
        _ => 0.0,
    }
}
