//! What BAM knows of a servo as joint.toml.

use std::fmt::Write;

use super::image::Surroundings;
use super::parameters::Parameters;
use crate::actuator::{Constant, Kind, Known, Preset};
use crate::figures::{digits, quantity};

/// BAM's actuators that are presets here, by the beginning of their name there.
const PRESETS: [(&str, &str); 6] = [
    ("xl330", "XL330"),
    ("xl320", "XL320"),
    ("mx64", "MX-64"),
    ("mx106", "MX-106"),
    ("sts3215", "STS3215"),
    ("feetech_hls", "HLS2915"),
];

/// joint.toml of a servo: `[actuator]`, its armature, the payload, and for `trainer simulate` and `trainer loop` the friction that `[plant]` has.
/// Constants that BAM does not know are left open, and stand there as comments. With it what was not taken, in sentences.
#[must_use]
pub fn joint_file(parameters: &Parameters, surroundings: &Surroundings, title: &str) -> (String, Vec<String>) {
    let preset = PRESETS.iter().find(|(name, _)| parameters.actuator.starts_with(name));
    let preset = preset.and_then(|(_, name)| Preset::named(name));
    let kind = preset.map_or_else(|| kind_of(parameters), |preset| preset.kind);
    let mut text = format!("# {title}\nname = {:?}\n\n[actuator]\n", parameters.actuator);
    match preset {
        Some(preset) => tell(&mut text, "preset", &format!("{:?}", preset.name)),
        None => tell(&mut text, "kind", &format!("{:?}", kind.name())),
    }
    let mut taken = vec!["q_offset", "armature"];
    for (constant, key, value) in constants(parameters, surroundings, preset) {
        if kind.constants().contains(&constant) {
            tell(&mut text, constant.key(), &value.to_string());
            taken.push(key);
        }
    }
    let needed = [Constant::Supply, Constant::FirmwareKp, Constant::FirmwareErrorGain];
    for constant in needed.into_iter().filter(|constant| kind.constants().contains(constant)) {
        let by_preset = preset.is_some_and(|preset| preset.constants.iter().any(|(known, _)| *known == constant));
        if !by_preset && !text.contains(&format!("\n{} = ", constant.key())) {
            let _ = writeln!(
                text,
                "# {} = ...    # BAM's file does not say it; `simulate` and `loop` need it",
                constant.key()
            );
        }
    }
    let armature = parameters.get("armature");
    if let Some(inertia) = armature {
        let _ = write!(text, "\n[rigid_body]\ninertia_kgm2 = {inertia}\n");
    }
    if let Some(payload) = &surroundings.payload {
        text += "\n[payload]\n";
        let values =
            [("mass_kg", payload.mass_kg), ("distance_m", payload.distance_m), ("phase_rad", payload.phase_rad)];
        for (key, value) in values.into_iter().filter(|(key, value)| *key != "phase_rad" || *value != 0.0) {
            tell(&mut text, key, &value.to_string());
        }
    }
    text += &plant(parameters, surroundings, armature.unwrap_or(0.0));
    let motor = ["kt", "R", "command_delay", "error_gain_ratio", "max_velocity", "current_limit"];
    let unused: Vec<&str> =
        motor.into_iter().filter(|key| parameters.get(key).is_some() && !taken.contains(key)).collect();
    (text, remarks(parameters, surroundings, kind, &unused))
}

fn tell(text: &mut String, key: &str, value: &str) {
    let _ = writeln!(text, "{key} = {value}");
}

/// A number that was worked out, to ten digits.
fn worked_out(value: f64) -> f64 {
    format!("{value:.9e}").parse().unwrap_or(value)
}

/// What an actuator is that is no preset.
fn kind_of(parameters: &Parameters) -> Kind {
    match (parameters.get("kt"), parameters.get("R")) {
        (Some(_), Some(_)) => Kind::PositionServo,
        (Some(_), None) => Kind::Current,
        _ => Kind::Torque,
    }
}

/// The constants that BAM knows, each with the key that says it there.
fn constants(
    parameters: &Parameters,
    surroundings: &Surroundings,
    preset: Option<&Preset>,
) -> Vec<(Constant, &'static str, f64)> {
    let error_gain = preset.and_then(|preset| {
        let mut constants = preset.constants.iter();
        constants
            .find(|(constant, _)| *constant == Constant::FirmwareErrorGain)
            .and_then(|(_, known)| Known::given(*known))
    });
    let limit =
        parameters.get("kt").zip(parameters.get("current_limit")).map(|(constant, limit)| worked_out(constant * limit));
    let ratio = parameters.get("error_gain_ratio").zip(error_gain).map(|(ratio, gain)| worked_out(ratio * gain));
    let known = [
        (Constant::TorqueConstant, "kt", parameters.get("kt")),
        (Constant::Resistance, "R", parameters.get("R")),
        (Constant::Supply, "", surroundings.supply),
        (Constant::FirmwareKp, "", surroundings.firmware_kp),
        (Constant::TorqueLimit, "current_limit", limit),
        (Constant::FirmwareErrorGain, "error_gain_ratio", ratio),
        (Constant::Delay, "command_delay", parameters.get("command_delay")),
        (Constant::VelocityLimit, "max_velocity", parameters.get("max_velocity")),
    ];
    known.into_iter().filter_map(|(constant, key, value)| Some((constant, key, value?))).collect()
}

/// The joint that `trainer simulate` and `trainer loop` move.
fn plant(parameters: &Parameters, surroundings: &Surroundings, armature: f64) -> String {
    let body = surroundings.body();
    let (gravity, phase) = surroundings.gravity().unwrap_or_default();
    let mut text = String::from("\n[plant]\n");
    let inertia = armature + body.inertia;
    if inertia > 0.0 {
        tell(&mut text, "inertia_kgm2", &worked_out(inertia).to_string());
    }
    tell(&mut text, "gravity_torque_Nm", &format!("[{:?}]", worked_out(gravity)));
    if phase != 0.0 {
        tell(&mut text, "gravity_phase_rad", &phase.to_string());
    }
    text += "\n[plant.friction]\n";
    let of_friction = [
        ("coulomb_torque_Nm", "friction_base"),
        ("viscous_Nm_s_rad", "friction_viscous"),
        ("stribeck_torque_Nm", "friction_stribeck"),
        ("stribeck_velocity_rad_s", "dtheta_stribeck"),
        ("stribeck_exponent", "alpha"),
        ("load_friction_motor", "load_friction_motor"),
        ("load_friction_external", "load_friction_external"),
        ("load_friction_motor_stribeck", "load_friction_motor_stribeck"),
        ("load_friction_external_stribeck", "load_friction_external_stribeck"),
        // The same share of both torques.
        ("load_friction_motor", "load_friction_base"),
        ("load_friction_external", "load_friction_base"),
        ("load_friction_motor_stribeck", "load_friction_stribeck"),
        ("load_friction_external_stribeck", "load_friction_stribeck"),
    ];
    for (key, of_bam) in of_friction {
        if let Some(value) = parameters.get(of_bam) {
            tell(&mut text, key, &format!("{value:?}"));
        }
    }
    text
}

/// What is not taken from a file, and with what torque.
fn remarks(parameters: &Parameters, surroundings: &Surroundings, kind: Kind, unused: &[&str]) -> Vec<String> {
    let mut told = Vec::new();
    if let Some(offset) = parameters.get("q_offset").filter(|offset| *offset != 0.0) {
        told.push(format!("q_offset of {} is one of BAM's bench and not taken", quantity(offset, "rad")));
    }
    for key in unused {
        told.push(format!("{key} is no constant of an actuator of kind `{}` and not taken", kind.name()));
    }
    for key in &parameters.left_out {
        told.push(format!("{key} is no parameter of `{}` and not taken", parameters.variant.name()));
    }
    if parameters.variant.load().is_none() {
        return told;
    }
    let squares = ["load_friction_motor_quad", "load_friction_external_quad"];
    let given = |keys: &[&'static str], unit: &str| -> Vec<String> {
        let above_zero = |key: &&'static str| Some((*key, parameters.get(key).filter(|share| *share > 0.0)?));
        keys.iter().filter_map(above_zero).map(|(key, share)| format!("{key} {} {unit}", digits(share))).collect()
    };
    if surroundings.gravity().is_none() {
        let shares = [
            "load_friction_external",
            "load_friction_external_stribeck",
            "load_friction_base",
            "load_friction_stribeck",
        ];
        let lacking = [given(&shares, "N m"), given(&squares, "N m of its square")].concat();
        let lacking = if lacking.is_empty() { "nothing".to_owned() } else { lacking.join(", ") };
        told.push(format!("without a payload the law lacks what each N m from outside adds: {lacking}"));
    } else {
        told.push("the torque from outside is that of this payload; another one needs another image".to_owned());
    }
    if squares.into_iter().any(|key| parameters.friction(key) > 0.0) && surroundings.gravity().is_some() {
        let hanging = surroundings.gravity().map_or(0.0, |(amplitude, _)| amplitude);
        let most = squares.into_iter().map(|key| parameters.friction(key)).fold(0.0, f64::max) * hanging * hanging;
        told.push(format!(
            "[plant.friction] has no {}: the joint of `simulate` and `loop` lacks up to {}",
            squares.join(" and "),
            quantity(most, "N m")
        ));
    }
    told
}
