//! What makes the torque of a joint that does not report it: `[actuator]` and `[payload]` as far as the columns tell, all of it commented out.

use std::fmt::Write as _;

use super::candidate::{Candidate, has, is_measured};
use crate::actuator::{Kind, PRESETS};
use crate::recording::quantity::Quantity;

/// Where all of it is explained.
pub(super) const PAGE: &str = "docs/servos.md";

/// What an actuator is told, with the quantities beside it that it reads.
const COMMANDS: [Quantity; 7] = [
    Quantity::ReferencePosition,
    Quantity::ReferenceVelocity,
    Quantity::FeedForward,
    Quantity::Duty,
    Quantity::Voltage,
    Quantity::TorqueEnabled,
    Quantity::Kp,
];

/// The kind that the columns speak of; `None` where the torque is recorded, or nothing that makes one.
pub(super) fn kind(found: &[Candidate]) -> Option<Kind> {
    if is_measured(found) {
        return None;
    }
    let is_controlled = has(found, &[Quantity::ReferenceVelocity, Quantity::FeedForward]);
    match has(found, &[Quantity::ReferencePosition]) {
        _ if has(found, &[Quantity::Duty]) => Some(Kind::DcMotor),
        true if is_controlled => Some(Kind::Pd),
        true => Some(Kind::PositionServo),
        false => has(found, &[Quantity::Voltage]).then_some(Kind::DcMotor),
    }
}

/// What was found of it, in a sentence without a full stop.
pub(super) fn sentence(kind: Kind, found: &[Candidate]) -> String {
    let told = found.iter().filter(|candidate| COMMANDS.contains(&candidate.quantity));
    let told: Vec<&str> = told.map(|candidate| candidate.quantity.name()).collect();
    format!(
        "no column looks like torque, force or current, but {} may tell it: see [actuator], proposed of kind {}, and {PAGE}",
        told.join(", "),
        kind.name()
    )
}

/// The sections, commented out.
pub(super) fn sections(kind: Kind) -> String {
    let what = match kind {
        Kind::Pd => {
            "torque of position and velocity error; a servo whose firmware makes a duty of the error: position_servo"
        }
        Kind::PositionServo => {
            "a motor under the duty that the firmware makes of the position error; a controller that puts out a torque: pd"
        }
        Kind::DcMotor => "a motor under a duty or a voltage",
        Kind::Torque | Kind::Current => "",
    };
    let mut text = format!(
        "# What makes the torque, of a joint that does not report it ({PAGE}): take away the # of what you know, the rest is identified.\n# [actuator]\n"
    );
    // Writing to a string cannot fail.
    let mut line = |entry: String, why: &str| {
        let _ = if why.is_empty() { writeln!(text, "# {entry}") } else { writeln!(text, "# {entry:<34} # {why}") };
    };
    line(format!("kind = \"{}\"", kind.name()), what);
    let example = PRESETS.iter().find(|preset| preset.kind == kind).unwrap_or(&PRESETS[0]);
    line(
        format!("preset = \"{}\"", example.name),
        &format!("in place of kind, with published constants; there are {}", presets()),
    );
    for constant in kind.constants() {
        line(format!("{} = ...", constant.key()), constant.meaning());
    }
    line("[payload]".to_owned(), "what hangs at the joint and was weighed: it says how large all torques are");
    line("mass_kg = ...".to_owned(), "");
    line("distance_m = ...".to_owned(), "of its centre from the axis");
    line("[recordings.\"*-kp100.csv\"]".to_owned(), "what differs from file to file; * stands for any letters");
    let own = match kind {
        Kind::Pd => "kp_Nm_rad = ...",
        Kind::PositionServo => "firmware_kp = ...",
        Kind::Torque | Kind::Current | Kind::DcMotor => "supply_V = ...",
    };
    line(own.to_owned(), "also payload_kg, payload_m, supply_V, kp_Nm_rad, kd_Nms_rad");
    text
}

/// The names of the presets, by kind.
fn presets() -> String {
    let mut kinds: Vec<Kind> = Vec::new();
    for preset in &PRESETS {
        if !kinds.contains(&preset.kind) {
            kinds.push(preset.kind);
        }
    }
    let names = |kind: &Kind| {
        let of_kind = PRESETS.iter().filter(|preset| preset.kind == *kind).map(|preset| preset.name);
        format!("{} ({})", of_kind.collect::<Vec<_>>().join(", "), kind.name())
    };
    kinds.iter().map(names).collect::<Vec<_>>().join("; ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::Joint;

    #[test]
    fn the_sections_are_read_once_they_are_filled_in() {
        for kind in [Kind::Pd, Kind::PositionServo, Kind::DcMotor] {
            let sections = sections(kind);
            assert!(sections.lines().all(|line| line.starts_with("# ")), "{sections}");
            assert_eq!(Joint::parse(&sections).unwrap(), Joint::default());
            let filled = sections.lines().skip(1).map(|line| line.trim_start_matches("# ").replace("...", "0.5"));
            let filled: Vec<String> = filled.filter(|line| !line.starts_with("preset")).collect();
            let joint = Joint::parse(&filled.join("\n")).unwrap();
            assert_eq!(joint.actuator.kind, kind);
            assert_eq!(joint.actuator.constants.len(), kind.constants().len());
            assert!(joint.payload.is_some() && joint.recordings.len() == 1);
            assert!(PRESETS.iter().all(|preset| sections.contains(preset.name)));
        }
    }
}
