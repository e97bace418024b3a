//! Hysteretic windup of a transmission (Taghirad & Belanger 1998), as a Dahl element.

use frikan_shared::elementary::decay;

use super::presliding::turned_over;
use super::{Contribution, Memory, Motion};

/// `z <- z r + (1 - r) S`, `r = exp(-|dq| / distance)`, `S` the sign of `dq`; adds `torque z`. The memory is how far it is wound, -1 to 1.
#[must_use]
#[inline(never)]
pub fn step(torque: f32, distance: f32, [share, ..]: &mut Memory, motion: &Motion) -> Contribution {
    let now = turned_over(*share, motion.travel, decay(motion.travel / distance));
    *share = motion.usable.or(now, *share);
    Contribution::torque(torque * now)
}
