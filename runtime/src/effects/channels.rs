//! Terms of another channel: temperature and load.

use frikan_shared::effect::Effect;
use frikan_shared::elementary::exp;

use super::Motion;

/// Torque of a channel term; 0 for any other effect.
#[must_use]
#[inline(never)]
pub fn torque(effect: &Effect, motion: &Motion) -> f32 {
    match *effect {
        Effect::Temperature { reference, coulomb, viscous, decay, smoothing_velocity } => {
            let warmth = motion.temperature - reference;
            let thinned = if decay > 0.0 { (1.0 - exp(-(decay * warmth))) / decay } else { warmth };
            coulomb * motion.smooth_sign(smoothing_velocity) * warmth + viscous * motion.velocity * thinned
        }
        Effect::Load { mean, difference, quadratic, stribeck, velocity, smoothing_velocity } => {
            let sign = motion.smooth_sign(smoothing_velocity);
            let load = motion.load;
            let ratio = motion.velocity / velocity;
            let coefficient = mean + stribeck * exp(-(ratio * ratio));
            coefficient * load.abs() * sign + difference * load * sign.abs() + quadratic * load * load * sign
        }
        _ => 0.0,
    }
}
