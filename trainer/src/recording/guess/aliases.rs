//! Which quantity a column is likely to be by its name, and which joint it belongs to.

use crate::recording::names::{JointState, plain, split_unit};
use crate::recording::quantity::Quantity;

/// Other names of a quantity in small letters, the likelier first; as loggers, drives and papers write them.
const ALIASES: &[(Quantity, &[&str])] = &[
    (Quantity::Time, &["time", "t", "timestamp", "timestamps", "elapsed_time", "elapsed", "stamp", "seconds", "clock"]),
    (
        Quantity::Position,
        &[
            "position",
            "pos",
            "q",
            "angle",
            "theta",
            "joint_position",
            "actual_position",
            "actual_q",
            "position_actual",
            "present_position",
            "measured_position",
            "joint_pos",
            "qpos",
            "phi",
            "x",
            "observation.state",
            "state",
        ],
    ),
    (
        Quantity::Velocity,
        &[
            "velocity",
            "vel",
            "dq",
            "qd",
            "qdot",
            "speed",
            "omega",
            "joint_velocity",
            "actual_velocity",
            "actual_qd",
            "velocity_actual",
            "present_velocity",
            "measured_velocity",
            "joint_vel",
            "qvel",
            "dtheta",
            "v",
        ],
    ),
    (
        Quantity::Torque,
        &[
            "torque",
            "tau",
            "effort",
            "trq",
            "joint_torque",
            "actual_torque",
            "torque_actual",
            "measured_torque",
            "motor_torque",
            "tau_j",
            "tau_measured",
            "moment",
            "m",
        ],
    ),
    (Quantity::Force, &["force", "f", "actual_force", "measured_force"]),
    (
        Quantity::Current,
        &[
            "current",
            "cur",
            "i",
            "iq",
            "i_q",
            "motor_current",
            "actual_current",
            "current_actual",
            "present_current",
            "measured_current",
        ],
    ),
    (Quantity::Acceleration, &["acceleration", "acc", "ddq", "qdd", "qacc"]),
    (Quantity::Temperature, &["temperature", "temp", "motor_temperature", "present_temperature"]),
    (Quantity::LinkPosition, &["link_position", "link_pos", "output_position", "secondary_position"]),
    (
        Quantity::ReferencePosition,
        &[
            "reference_position",
            "goal_position",
            "desired_position",
            "target_position",
            "commanded_position",
            "q_des",
            "q_d",
            "qd_des",
            "reference",
            "command",
        ],
    ),
    (Quantity::Voltage, &["voltage", "bus_voltage", "supply_voltage", "present_voltage"]),
];

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
        ] {
            let read = read(name).unwrap_or_else(|| panic!("{name}"));
            assert_eq!((read.quantity, read.joint.as_str(), read.unit.as_deref()), (quantity, joint, unit), "{name}");
        }
        for name in ["kp", "pressure_bar", "phase", "frame_index", ""] {
            assert_eq!(read(name), None, "{name}");
        }
    }
}
