//! Presliding: Maxwell slip elements, stepped exactly over the distance travelled.

use frikan_shared::effect::Element;
use frikan_shared::elementary::decay;

use super::{Contribution, Memory, Motion};

/// `z <- z r + (1 - r) S`, `r = exp(-|dq| / distance)`, `S` the sign of `dq`, for each element; what they add is the sum of `torque z`, less
/// the sum of `torque` times `s(v)`. The memory is how far each element is stretched, -1 to 1.
///
/// The step is the exact solution of `dz/dx = (sgn(dx) - z) / distance` (Dahl 1968): it cannot overshoot, however long the sample, and leaves
/// an element as it is where nothing moves.
#[must_use]
#[inline(always)]
pub fn step(smoothing_velocity: f32, elements: &[Element], memory: &mut Memory, motion: &Motion) -> Contribution {
    let smooth_sign = motion.smooth_sign(smoothing_velocity);
    // One element is the commonest: it takes no loop and no call.
    if let ([element], [share, ..]) = (elements, &mut *memory) {
        let now = turned_over(*share, motion.travel, decay(motion.travel / element.distance));
        *share = motion.usable.or(now, *share);
        return Contribution::torque(element.torque * now - element.torque * smooth_sign);
    }
    let (mut torque, mut slipping) = (0.0, 0.0);
    for (element, share) in elements.iter().zip(memory) {
        let now = turned_over(*share, motion.travel, decay_apart(motion.travel.abs() / element.distance));
        *share = motion.usable.or(now, *share);
        torque += element.torque * now;
        slipping += element.torque;
    }
    Contribution::torque(torque - slipping * smooth_sign)
}

/// [`step`] as a function of its own.
#[must_use]
#[inline(never)]
pub(super) fn call(
    smoothing_velocity: f32,
    elements: &[Element],
    memory: &mut Memory,
    motion: &Motion,
) -> Contribution {
    step(smoothing_velocity, elements, memory, motion)
}

/// [`decay`] as a function of its own: its constants take more registers than a loop has.
#[inline(never)]
fn decay_apart(x: f32) -> f32 {
    decay(x)
}

/// A share of -1 to 1 after a way that leaves `left` of its distance to the direction of the way.
#[must_use]
#[inline(always)]
pub(super) fn turned_over(share: f32, travel: f32, left: f32) -> f32 {
    share * left + (1.0 - left).copysign(travel)
}
