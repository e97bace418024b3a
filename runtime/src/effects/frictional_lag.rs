//! Frictional lag: friction follows the velocity of a moment ago (Hess & Soom 1990).

use frikan_shared::elementary::lag_share;

use super::{Memory, Motion, STARTED};

/// Advances the lag and returns the lagged velocity, rad/s. The memory is that velocity, within the trained range, and whether there was
/// a sample before; the first one starts without lag.
#[must_use]
#[inline(never)]
pub fn step(time_constant: f32, [velocity, started, ..]: &mut Memory, motion: &Motion) -> f32 {
    let before = if *started == STARTED { *velocity } else { motion.velocity };
    let now = before + lag_share(motion.dt / time_constant) * (motion.velocity - before);
    *velocity = motion.usable.or(now, *velocity);
    *started = motion.usable.or(STARTED, *started);
    now
}
