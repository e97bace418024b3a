//! What a recording is asked for and no column looks like.

use super::actuator;
use super::candidate::{Candidate, has, is_measured};
use crate::recording::quantity::Quantity;

/// Quantities that no column looks like, each told by itself, without a full stop.
pub(super) fn sentences(found: &[Candidate]) -> Vec<String> {
    let lacks = |quantity| !has(found, &[quantity]);
    let separated = has(found, &[Quantity::FrictionTorque, Quantity::FrictionForce]);
    let mut sentences = Vec::new();
    if lacks(Quantity::Time) && !separated {
        sentences.push("no column looks like the time: `fit` needs one".to_owned());
    }
    if lacks(Quantity::Position) && lacks(Quantity::LinkPosition) && !separated {
        let sentence = if lacks(Quantity::Velocity) {
            "no column looks like the position or the velocity: `fit` needs one"
        } else {
            "no column looks like the position: gravity and friction over the position cannot be told without"
        };
        sentences.push(sentence.to_owned());
    }
    match actuator::kind(found) {
        Some(kind) => sentences.push(actuator::sentence(kind, found)),
        None if !is_measured(found) => {
            sentences.push("no column looks like torque, force or current: `fit` needs one".to_owned());
        }
        None => {}
    }
    sentences
}

/// The same as names of quantities, for what a column that nothing was taken for may be.
pub(super) fn quantities(found: &[Candidate]) -> Vec<Quantity> {
    let mut missing = Vec::new();
    for quantity in [Quantity::Time, Quantity::Position, Quantity::Velocity] {
        if !has(found, &[quantity]) {
            missing.push(quantity);
        }
    }
    if !is_measured(found) {
        missing.extend([Quantity::Torque, Quantity::Force, Quantity::Current]);
    }
    missing
}
