//! Which quantity a column is likely to be by its name, and which joint it belongs to.

use super::words::ALIASES;
use crate::recording::names::{JointState, plain, split_unit};
use crate::recording::quantity::Quantity;

/// Words that name a joint in front of a quantity, followed by its number.
const JOINT_WORDS: [&str; 4] = ["joint", "axis", "motor", "j"];

/// What the name of a column says.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::recording) struct Reading {
    pub(in crate::recording) quantity: Quantity,
    /// How far down the list of names it stands: the lower, the likelier.
    pub(in crate::recording) rank: usize,
    /// Which of several joints, empty where the name says none.
    pub(in crate::recording) joint: String,
    /// The unit in the name.
    pub(in crate::recording) unit: Option<String>,
}

/// Reads the name of a column.
pub(in crate::recording) fn read(name: &str) -> Option<Reading> {
    if let Some(state) = JointState::of(name) {
        return Some(Reading {
            quantity: state.quantity,
            rank: 0,
            joint: state.source.to_owned(),
            unit: Some(state.unit.suffix.to_owned()),
        });
    }
    let (base, unit) = split_unit(name).map_or((name, None), |(base, unit)| (base, Some(unit.to_owned())));
    let base = plain(base);
    let base = base.rsplit('/').next().unwrap_or(&base);
    let (stem, joint) = split_joint(base);
    let of = |stem: &str| {
        ALIASES
            .iter()
            .find_map(|(quantity, names)| names.iter().position(|name| *name == stem).map(|rank| (*quantity, rank)))
    };
    if let Some((quantity, rank)) = of(&stem) {
        return Some(Reading { quantity, rank, joint, unit });
    }
    // A unit behind the name, as in `pos_deg`.
    let cuts = stem.char_indices().filter(|(_, letter)| *letter == '_');
    cuts.rev().find_map(|(at, _)| {
        let (quantity, rank) = of(&stem[..at])?;
        let unit = quantity.units().iter().find(|unit| unit.suffix.to_lowercase() == stem[at + 1..])?;
        Some(Reading { quantity, rank, joint: joint.clone(), unit: Some(unit.suffix.to_owned()) })
    })
}

/// `q[1]`, `joint2_position`, `tau_3` as what is measured and at which joint.
fn split_joint(name: &str) -> (String, String) {
    if let Some((stem, index)) = name.strip_suffix(']').and_then(|inside| inside.rsplit_once('[')) {
        return (stem.to_owned(), format!("[{index}]"));
    }
    for word in JOINT_WORDS {
        let Some(rest) = name.strip_prefix(word) else { continue };
        let digits: String = rest.trim_start_matches('_').chars().take_while(char::is_ascii_digit).collect();
        let behind = rest.trim_start_matches('_').trim_start_matches(|letter: char| letter.is_ascii_digit());
        let stem = behind.trim_start_matches(['_', '.', ' ']);
        if !digits.is_empty() && !stem.is_empty() {
            return (stem.to_owned(), digits);
        }
    }
    let stem = name.trim_end_matches(|letter: char| letter.is_ascii_digit());
    if stem.len() < name.len() && !stem.is_empty() {
        return (stem.trim_end_matches('_').to_owned(), name[stem.len()..].to_owned());
    }
    (name.to_owned(), String::new())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_loggers_are_read() {
        for (name, quantity, joint, unit) in [
            ("time", Quantity::Time, "", None),
            ("q", Quantity::Position, "", None),
            ("dq2", Quantity::Velocity, "2", None),
            ("tau_3", Quantity::Torque, "3", None),
            ("position[1]", Quantity::Position, "[1]", None),
            ("joint2_position", Quantity::Position, "2", None),
            ("Motor Current [mA]", Quantity::Current, "", Some("mA")),
            ("pos_deg", Quantity::Position, "", Some("deg")),
            ("/joint_states/elbow/effort", Quantity::Torque, "/joint_states/elbow", Some("Nm")),
            ("observation.state[3]", Quantity::Position, "[3]", None),
            ("motor_angle", Quantity::Position, "", None),
            ("Encoder", Quantity::Position, "", None),
            ("Drehzahl [rpm]", Quantity::Velocity, "", Some("rpm")),
            ("Couple", Quantity::Torque, "", None),
            ("Posición", Quantity::Position, "", None),
        ] {
            let read = read(name).unwrap_or_else(|| panic!("{name}"));
            assert_eq!((read.quantity, read.joint.as_str(), read.unit.as_deref()), (quantity, joint, unit), "{name}");
        }
        for name in ["kp", "pressure_bar", "phase", "frame_index", ""] {
            assert_eq!(read(name), None, "{name}");
        }
    }
}
