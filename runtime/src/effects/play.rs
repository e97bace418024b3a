//! Backlash as the play operator (Ruderman, Hoffmann & Bertram 2009).

use super::{Contribution, Motion};

/// The link behind the play.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Link {
    /// rad, within half a width of the motor.
    position: f32,
    /// Whether there was a sample before; the first one starts in the middle.
    started: bool,
}

/// `w <- min(max(w, q - half_width), q + half_width)`; adds `torque (q - w) / half_width` and moves the link by `w - q`.
#[must_use]
pub fn step(half_width: f32, torque: f32, link: &mut Link, motion: &Motion) -> Contribution {
    let (low, high) = (motion.position - half_width, motion.position + half_width);
    let before = if link.started { link.position } else { motion.position };
    let raised = if before > low { before } else { low };
    *link = Link { position: if raised < high { raised } else { high }, started: true };
    let behind = motion.position - link.position;
    Contribution { torque: torque * (behind / half_width), position: -behind }
}
