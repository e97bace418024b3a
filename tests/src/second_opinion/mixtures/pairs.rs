//! Two effects at once, and each of them by itself.

use super::PROTOCOLS;
use super::added::{Taken, record};
use crate::second_opinion::{Case, Part};

/// Both effects, and which protocol records them.
const PAIRS: [(&str, &str, usize); 12] = [
    ("stribeck", "position_ripple", 0),
    ("temperature", "presliding", 7),
    ("torque_offset", "load_friction", 2),
    ("viscous_nonlinearity", "direction_asymmetry", 3),
    ("gravity_error", "stribeck", 4),
    ("inertia_error", "position_ripple", 2),
    ("contact", "viscous_nonlinearity", 0),
    ("spring", "slow_drift", 7),
    ("transient_event", "load_friction", 0),
    ("position_friction", "inertia_error", 4),
    ("stribeck", "position_ripple", 5),
    ("temperature", "gravity_error", 6),
];

pub(super) fn cases() -> Vec<Case> {
    let mut pairs = Vec::new();
    let mut halves = Vec::new();
    for (index, (first, second, protocol)) in PAIRS.into_iter().enumerate() {
        let number = index + 1;
        pairs.push(case(format!("pair-{number}"), Part::Pairs, vec![first, second], protocol));
        for (half, name) in [("a", first), ("b", second)] {
            halves.push(case(format!("half-{number}{half}"), Part::Halves, vec![name], protocol));
        }
    }
    pairs.append(&mut halves);
    pairs
}

fn case(name: String, part: Part, effects: Vec<&'static str>, protocol: usize) -> Case {
    let hidden = effects.clone();
    Case::new(name, part, effects, move |random| {
        let protocol = &PROTOCOLS[protocol];
        let fine = protocol.fine(random);
        let (real, note) = record(protocol, &fine, &hidden, Taken::by(protocol, fine.step), random);
        protocol.of(&fine.joint, real, &note)
    })
}
