//! Backlash as the play operator (Ruderman, Hoffmann & Bertram 2009).

use super::{Contribution, Memory, Motion, STARTED};

/// `w <- min(max(w, q - half_width), q + half_width)`; adds `torque (q - w) / half_width` and moves the link by `w - q`. The memory is the
/// link's position, rad, and whether there was a sample before; the first one starts in the middle.
#[must_use]
#[inline(never)]
pub fn step(half_width: f32, torque: f32, [link, started, ..]: &mut Memory, motion: &Motion) -> Contribution {
    let (low, high) = (motion.position - half_width, motion.position + half_width);
    let before = if *started == STARTED { *link } else { motion.position };
    let raised = if before > low { before } else { low };
    let now = if raised < high { raised } else { high };
    *link = motion.usable.or(now, *link);
    *started = motion.usable.or(STARTED, *started);
    let behind = motion.position - now;
    Contribution { torque: torque * (behind / half_width), position: -behind }
}
