//! Presliding: the bristle of LuGre and Dahl, stepped exactly over the distance travelled.

use frikan_shared::effect::Effect;
use frikan_shared::elementary::{exp, sign};

use super::{Contribution, Motion};
use crate::evaluate::limited;

/// The bristle's torque, N m, at most the breakaway torque in magnitude.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Bristle {
    torque: f32,
}

/// `z <- S + (z - S) exp(-|dq| stiffness / g)`; what it adds is `z - g s(v)`.
///
/// The step is the exact solution of LuGre's `dz/dx = sigma_0 (sgn - z / g)` at constant `g`: it cannot overshoot, however long
/// the sample.
#[must_use]
pub fn step(effect: &Effect, bristle: &mut Bristle, motion: &Motion) -> Contribution {
    let Effect::Presliding { coulomb, breakaway, velocity, stiffness, smoothing_velocity } = *effect else {
        return Contribution::default();
    };
    let ratio = motion.velocity / velocity;
    let sliding = coulomb + (breakaway - coulomb) * exp(-(ratio * ratio));
    let distance = motion.velocity * motion.dt;
    let target = sliding * sign(distance);
    let remaining = exp(-(distance.abs() * stiffness / sliding));
    let torque = target + (bristle.torque - target) * remaining;
    bristle.torque = limited(torque, if coulomb > breakaway { coulomb } else { breakaway });
    Contribution::torque(bristle.torque - sliding * motion.smooth_sign(smoothing_velocity))
}
