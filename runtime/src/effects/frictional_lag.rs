//! Frictional lag: friction follows the velocity of a moment ago (Hess & Soom 1990).

use frikan_shared::elementary::lag_share;

use super::Motion;

/// The lagged velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Lag {
    /// rad/s, within the trained range.
    velocity: f32,
    /// Whether there was a sample before; the first one starts without lag.
    started: bool,
}

/// Advances the lag and returns the lagged velocity, rad/s.
#[must_use]
pub fn step(time_constant: f32, lag: &mut Lag, motion: &Motion) -> f32 {
    let before = if lag.started { lag.velocity } else { motion.velocity };
    lag.velocity = before + lag_share(motion.dt / time_constant) * (motion.velocity - before);
    lag.started = true;
    lag.velocity
}
