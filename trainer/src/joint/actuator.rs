//! `[actuator]`, `[payload]` and `[recordings]` of `joint.toml`: what is known of a joint that does not report its torque.

use std::collections::BTreeMap;

use serde::Deserialize;

use crate::actuator::{Constant, Constants, Kind, Known, Preset};

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
    feedback_delay_s: Option<Known>,
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
            Constant::FeedbackDelay => self.feedback_delay_s,
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
