//! Warm-up without a sensor: one thermal state driven by the dissipated power (Simoni et al. 2015).

use frikan_shared::effect::Effect;
use frikan_shared::elementary::lag_share;

use super::{Contribution, Motion};

/// The filtered power. A sample adds a millionth of it, less than an `f32` resolves, so that what rounding loses is carried along
/// (Kahan 1965).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Heat {
    /// W, between 0 and the power limit.
    power: f32,
    /// What the last additions put in too much, W.
    excess: f32,
}

/// `h += (1 - exp(-dt / time_constant)) (P - h)`; what it adds is `(coulomb s(v) + viscous v) h`.
#[must_use]
pub fn step(effect: &Effect, heat: &mut Heat, motion: &Motion) -> Contribution {
    let Effect::WarmUp { time_constant, coulomb, viscous, power_limit, smoothing_velocity } = *effect else {
        return Contribution::default();
    };
    let dissipated = (motion.law_torque * motion.velocity).abs();
    let dissipated = if dissipated < power_limit { dissipated } else { power_limit };
    let increment = lag_share(motion.dt / time_constant) * (dissipated - heat.power) - heat.excess;
    let power = heat.power + increment;
    heat.excess = (power - heat.power) - increment;
    let positive = if power > 0.0 { power } else { 0.0 };
    heat.power = if positive < power_limit { positive } else { power_limit };
    let slope = coulomb * motion.smooth_sign(smoothing_velocity) + viscous * motion.velocity;
    Contribution::torque(slope * heat.power)
}

impl Heat {
    /// What is left of it after a rest, s, in which nothing dissipates.
    #[must_use]
    pub fn after_rest(&self, effect: &Effect, rest: f32) -> Self {
        let Effect::WarmUp { time_constant, .. } = *effect else { return Self::default() };
        Self { power: self.power * (1.0 - lag_share(rest / time_constant)), excess: 0.0 }
    }
}
