//! Hysteretic windup of a transmission (Taghirad & Belanger 1998), as a Dahl element.

use frikan_shared::elementary::{exp, sign};

use super::{Contribution, Motion};
use crate::evaluate::limited;

/// How far it is wound, -1 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Winding {
    share: f32,
}

/// `z <- S + (z - S) exp(-|dq| / distance)`, `S = sgn(dq)`; adds `torque z`.
#[must_use]
pub fn step(torque: f32, distance: f32, winding: &mut Winding, motion: &Motion) -> Contribution {
    let travelled = motion.velocity * motion.dt;
    let target = sign(travelled);
    let share = target + (winding.share - target) * exp(-(travelled.abs() / distance));
    winding.share = limited(share, 1.0);
    Contribution::torque(torque * winding.share)
}
