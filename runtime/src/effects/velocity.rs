//! Terms of the velocity alone: corrections of the law's shape.

use frikan_shared::effect::Effect;
use frikan_shared::elementary::{exp, power};

use super::Motion;

/// Torque of a velocity term; 0 for any other effect.
#[must_use]
#[inline(never)]
pub fn torque(effect: &Effect, motion: &Motion) -> f32 {
    let v = motion.velocity;
    match *effect {
        Effect::Coulomb { coulomb, viscous, smoothing_velocity } => {
            coulomb * motion.smooth_sign(smoothing_velocity) + viscous * v
        }
        Effect::Stribeck { amplitude, velocity, exponent, smoothing_velocity } => {
            amplitude * exp(-power(v / velocity, exponent)) * motion.smooth_sign(smoothing_velocity)
        }
        Effect::PowerViscous { coefficient, exponent, smoothing_velocity } => {
            coefficient * power(v, exponent) * motion.smooth_sign(smoothing_velocity)
        }
        Effect::Asymmetry { coulomb, viscous, smoothing_velocity } => {
            coulomb * motion.smooth_sign(smoothing_velocity).abs() + viscous * v.abs()
        }
        _ => 0.0,
    }
}
