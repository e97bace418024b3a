//! Warm-up without a sensor: one thermal state driven by the dissipated power (Simoni et al. 2015).

use frikan_shared::effect::Effect;
use frikan_shared::elementary::lag_share;

use super::{Contribution, Memory, Motion};

/// `h += (1 - exp(-dt / time_constant)) (P - h)`; what it adds is `(coulomb s(v) + viscous v) h`. The memory is the filtered power, W,
/// between 0 and the power limit, and what the last additions put in too much, W: a sample adds a millionth of it, less than an `f32`
/// resolves, so that what rounding loses is carried along (Kahan 1965).
#[must_use]
#[inline(never)]
pub fn step(effect: &Effect, [heat, excess, ..]: &mut Memory, motion: &Motion) -> Contribution {
    let Effect::WarmUp { time_constant, coulomb, viscous, power_limit, smoothing_velocity } = *effect else {
        return Contribution::default();
    };
    let dissipated = (motion.law_torque * motion.velocity).abs();
    let dissipated = if dissipated < power_limit { dissipated } else { power_limit };
    let increment = lag_share(motion.dt / time_constant) * (dissipated - *heat) - *excess;
    let sum = *heat + increment;
    let too_much = (sum - *heat) - increment;
    let positive = if sum > 0.0 { sum } else { 0.0 };
    let power = if positive < power_limit { positive } else { power_limit };
    *heat = motion.usable.or(power, *heat);
    *excess = motion.usable.or(too_much, *excess);
    let slope = coulomb * motion.smooth_sign(smoothing_velocity) + viscous * motion.velocity;
    Contribution::torque(slope * power)
}

/// The memory after a rest, s, in which nothing dissipates, that begins with a filtered power of `heat`, W.
#[must_use]
pub fn after_rest(time_constant: f32, heat: f32, rest: f32) -> Memory {
    [heat * (1.0 - lag_share(rest / time_constant)), 0.0, 0.0, 0.0]
}
