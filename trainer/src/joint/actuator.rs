//! `[actuator]`, `[payload]` and `[recordings]` of `joint.toml`: what is known of a joint that does not report its torque.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::actuator::{Constant, Constants, Kind, Known, Preset};
use crate::error::{Error, Result, codes};

/// `[actuator]` as it stands in the file.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(non_snake_case, reason = "the keys of joint.toml carry their units as these are written")]
struct Table {
    kind: Option<Kind>,
    preset: Option<String>,
    torque_constant_Nm_A: Option<Known>,
    resistance_ohm: Option<Known>,
    torque_per_volt_Nm_V: Option<Known>,
    back_emf_Nms_rad: Option<Known>,
    supply_V: Option<Known>,
    supply_resistance_ohm: Option<Known>,
    duty_limit: Option<Known>,
    kp_Nm_rad: Option<Known>,
    kd_Nms_rad: Option<Known>,
    firmware_kp: Option<Known>,
    firmware_error_gain: Option<Known>,
    torque_limit_Nm: Option<Known>,
    dead_band_rad: Option<Known>,
    delay_s: Option<Known>,
    velocity_limit_rad_s: Option<Known>,
}

impl Table {
    fn known(&self, constant: Constant) -> Option<Known> {
        match constant {
            Constant::TorqueConstant => self.torque_constant_Nm_A,
            Constant::Resistance => self.resistance_ohm,
            Constant::TorquePerVolt => self.torque_per_volt_Nm_V,
            Constant::BackEmf => self.back_emf_Nms_rad,
            Constant::Supply => self.supply_V,
            Constant::SupplyResistance => self.supply_resistance_ohm,
            Constant::DutyLimit => self.duty_limit,
            Constant::Kp => self.kp_Nm_rad,
            Constant::Kd => self.kd_Nms_rad,
            Constant::FirmwareKp => self.firmware_kp,
            Constant::FirmwareErrorGain => self.firmware_error_gain,
            Constant::TorqueLimit => self.torque_limit_Nm,
            Constant::DeadBand => self.dead_band_rad,
            Constant::Delay => self.delay_s,
            Constant::VelocityLimit => self.velocity_limit_rad_s,
        }
    }
}

/// `[actuator]`: what makes the torque, and what is known of its constants.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(try_from = "Table")]
pub struct ActuatorTable {
    /// What it does with its command.
    pub kind: Kind,
    /// Name of the preset from which some of the constants are.
    pub preset: Option<String>,
    /// Those that are given or bounded, by the file or by the preset.
    pub constants: Constants,
}

impl TryFrom<Table> for ActuatorTable {
    type Error = String;

    fn try_from(table: Table) -> std::result::Result<Self, String> {
        let preset = match &table.preset {
            None => None,
            Some(name) => Some(Preset::named(name).ok_or_else(|| no_such_preset(name))?),
        };
        let kind = table.kind.or(preset.map(|preset| preset.kind)).unwrap_or_default();
        let mut constants: Constants =
            preset.filter(|preset| preset.kind == kind).iter().flat_map(|preset| preset.constants).copied().collect();
        for constant in Constant::ALL {
            let Some(known) = table.known(constant) else { continue };
            if !kind.constants().contains(&constant) {
                let keys: Vec<&str> = kind.constants().iter().map(|constant| constant.key()).collect();
                let (key, kind, keys) = (constant.key(), kind.name(), keys.join(", "));
                return Err(format!("an actuator of kind `{kind}` has no `actuator.{key}`; its constants are: {keys}"));
            }
            constants.insert(constant, known);
        }
        Ok(Self { kind, preset: preset.map(|preset| preset.name.to_owned()), constants })
    }
}

fn no_such_preset(name: &str) -> String {
    let names: Vec<&str> = crate::actuator::PRESETS.iter().map(|preset| preset.name).collect();
    format!("there is no preset `{name}`; there are: {}", names.join(", "))
}

/// `[payload]`: a known mass at the joint, beside what `[rigid_body]` says.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Payload {
    /// Mass, kg; zero or above.
    pub mass_kg: f64,
    /// Distance of its centre from the axis of the joint, m; zero or above.
    pub distance_m: f64,
    /// Phase of its gravity, rad: torque = mass g distance sin(position + phase).
    #[serde(default)]
    pub phase_rad: f64,
}

/// `[recordings."NAME"]`: what differs in the recordings whose file has this name; `*` stands for any letters.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(non_snake_case, reason = "the keys of joint.toml carry their units as these are written")]
pub struct OfRecording {
    /// Mass of the payload, kg.
    pub payload_kg: Option<f64>,
    /// Distance of the payload from the axis, m.
    pub payload_m: Option<f64>,
    /// Supply voltage, V.
    pub supply_V: Option<f64>,
    /// Gain of a PD controller, N m/rad.
    pub kp_Nm_rad: Option<f64>,
    /// Velocity gain of a PD controller, N m s/rad.
    pub kd_Nms_rad: Option<f64>,
    /// Gain of a servo's firmware.
    pub firmware_kp: Option<f64>,
}

/// `[recordings]`, by name.
pub type OfRecordings = BTreeMap<String, OfRecording>;

impl OfRecording {
    /// The constants that it gives.
    pub(super) fn constants(&self) -> impl Iterator<Item = (Constant, f64)> {
        let given = [
            (Constant::Supply, self.supply_V),
            (Constant::Kp, self.kp_Nm_rad),
            (Constant::Kd, self.kd_Nms_rad),
            (Constant::FirmwareKp, self.firmware_kp),
        ];
        given.into_iter().filter_map(|(constant, value)| Some((constant, value?)))
    }
}

impl super::Joint {
    /// What is known of the joint in the recording of this name: `[actuator]` and `[payload]` with what `[recordings]` says.
    #[must_use]
    pub fn in_recording(&self, label: &str) -> Self {
        let mut joint = self.clone();
        for (_, of) in self.recordings.iter().filter(|(pattern, _)| matches(pattern, label)) {
            joint.actuator.constants.extend(of.constants().map(|(constant, value)| (constant, Known::Given(value))));
            if of.payload_kg.is_some() || of.payload_m.is_some() {
                let payload = joint.payload.get_or_insert_default();
                payload.mass_kg = of.payload_kg.unwrap_or(payload.mass_kg);
                payload.distance_m = of.payload_m.unwrap_or(payload.distance_m);
            }
        }
        joint
    }

    /// Refuses constants and payloads that no joint can have.
    pub(super) fn check_actuator(&self) -> Result<()> {
        let bad = |key: String, rule: &str, value: f64| {
            Error::new(&codes::BAD_JOINT_FILE, rule).in_column(key).with_value(value.to_string())
        };
        let check = |key: String, constant: Constant, value: f64| {
            if constant.allows(value) { Ok(()) } else { Err(bad(key, constant.rule(), value)) }
        };
        for (constant, known) in &self.actuator.constants {
            let values = match *known {
                Known::Given(value) => [value, value],
                Known::Between(low, high) => [if low == 0.0 { high } else { low }, high],
            };
            for value in values {
                check(format!("actuator.{}", constant.key()), *constant, value)?;
            }
        }
        let zero_or_above = |value: f64| value.is_finite() && value >= 0.0;
        let rule = "this has to be a finite number, zero or above";
        if let Some(payload) = &self.payload {
            for (key, value) in [("mass_kg", payload.mass_kg), ("distance_m", payload.distance_m)] {
                if !zero_or_above(value) {
                    return Err(bad(format!("payload.{key}"), rule, value));
                }
            }
            if !payload.phase_rad.is_finite() {
                return Err(bad("payload.phase_rad".to_owned(), "this has to be a finite number", payload.phase_rad));
            }
        }
        for (name, of) in &self.recordings {
            for (constant, value) in of.constants() {
                let key = format!("recordings.{name}.{}", constant.key());
                if !self.actuator.kind.constants().contains(&constant) {
                    let rule = format!("an actuator of kind `{}` has no such constant", self.actuator.kind.name());
                    return Err(bad(key, &rule, value));
                }
                check(key, constant, value)?;
            }
            for (key, value) in [("payload_kg", of.payload_kg), ("payload_m", of.payload_m)] {
                if let Some(value) = value.filter(|value| !zero_or_above(*value)) {
                    return Err(bad(format!("recordings.{name}.{key}"), rule, value));
                }
            }
        }
        Ok(())
    }
}

/// Whether a pattern, in which `*` stands for any letters, fits a name.
fn matches(pattern: &str, name: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == name,
        Some((head, rest)) => name
            .strip_prefix(head)
            .is_some_and(|tail| (0..=tail.len()).filter_map(|at| tail.get(at..)).any(|tail| matches(rest, tail))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::Joint;

    #[test]
    fn keys_presets_bounds_and_recordings_are_read() {
        let joint = Joint::parse(
            r#"
            [actuator]
            preset = "xl330"
            torque_constant_Nm_A = [0.2, 0.5]
            dead_band_rad = 0
            [payload]
            mass_kg = 0.49
            distance_m = 0.1
            [recordings."*-kp100.csv"]
            firmware_kp = 100
            payload_kg = 0.2
            "#,
        )
        .unwrap();
        assert_eq!((joint.actuator.kind, joint.actuator.preset.as_deref()), (Kind::PositionServo, Some("XL330")));
        assert_eq!(joint.actuator.constants[&Constant::TorqueConstant], Known::Between(0.2, 0.5));
        let of = joint.in_recording("sin_sin-kp100.csv");
        assert_eq!(of.actuator.constants[&Constant::FirmwareKp], Known::Given(100.0));
        assert_eq!(of.payload.map(|payload| (payload.mass_kg, payload.distance_m)), Some((0.2, 0.1)));
        assert_eq!(joint.in_recording("sin_sin-kp1000.csv"), joint);
    }

    #[test]
    fn what_an_actuator_cannot_have_is_refused_with_its_key() {
        for (text, told) in [
            ("[actuator]\nkind = \"pd\"\nkp_Nm_deg = 3", "kp_Nm_deg"),
            ("[actuator]\nkind = \"pd\"\nresistance_ohm = 3", "actuator.resistance_ohm"),
            ("[actuator]\nkind = \"servo\"", "servo"),
            ("[actuator]\npreset = \"XL\"", "XL330"),
            ("[actuator]\nkind = \"pd\"\nkp_Nm_rad = -3", "actuator.kp_Nm_rad"),
            ("[actuator]\nkind = \"pd\"\nkp_Nm_rad = [5, 3]", "lowest"),
            ("[actuator]\nkind = \"dc_motor\"\nduty_limit = 1.5", "actuator.duty_limit"),
            ("[payload]\nmass_kg = -1\ndistance_m = 1", "payload.mass_kg"),
            ("[payload]\nmass_kg = 1", "distance_m"),
            ("[recordings.a]\nkp = 1", "kp"),
            ("[recordings.a]\nfirmware_kp = 1", "recordings.a.firmware_kp"),
        ] {
            let error = Joint::parse(text).unwrap_err();
            assert_eq!(error.code(), &codes::BAD_JOINT_FILE, "{text}");
            assert!(error.to_string().contains(told), "{text}: {error}");
        }
    }

    #[test]
    fn stars_stand_for_any_letters() {
        assert!(matches("*", "") && matches("a*b*c", "aXbYbc") && matches("run.csv", "run.csv"));
        assert!(!matches("a*b", "abc") && !matches("", "a"));
    }
}
