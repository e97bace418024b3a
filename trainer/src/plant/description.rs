//! From `joint.toml` to the joint that is simulated.

use super::joint::Joint;
use crate::actuator::{Actuator, Constant, Kind, Partial};
use crate::error::{Error, Result, codes};
use serde::Deserialize;

impl Joint {
    /// The joint of a `joint.toml`: its `[plant]` table, and where that is silent what `[rigid_body]` and `[drive]` say.
    ///
    /// # Errors
    /// `FRK-D015` when the table holds a key or value that is not understood.
    pub fn described_by(file: &crate::joint::Joint) -> Result<Self> {
        let mut table = match file.other.get("plant") {
            None => toml::Table::new(),
            Some(toml::Value::Table(table)) => table.clone(),
            Some(_) => return Err(Error::new(&codes::BAD_JOINT_FILE, "`plant` has to be a table")),
        };
        let mut inherit = |key: &str, value: Option<toml::Value>| {
            if let Some(value) = value {
                table.entry(key).or_insert(value);
            }
        };
        let body = &file.rigid_body;
        inherit("inertia_kgm2", body.inertia_kgm2.map(Into::into));
        inherit("gravity_phase_rad", body.gravity_phase_rad.map(Into::into));
        inherit("gravity_torque_Nm", body.gravity_torque_nm.map(|torque| vec![torque].into()));
        let drive = table.entry("drive").or_insert_with(|| toml::Table::new().into());
        if let toml::Value::Table(drive) = drive {
            let mut inherit = |key: &str, value: Option<f64>| {
                if let Some(value) = value {
                    drive.entry(key).or_insert(value.into());
                }
            };
            inherit("gear_ratio", file.drive.gear_ratio.map(f64::abs));
            inherit("torque_limit_Nm", file.drive.torque_limit_nm);
            inherit("rate_Hz", file.drive.rate_hz);
        }
        let joint = Self::deserialize(table).map_err(|error| {
            let message = format!("[plant]: {}", error.message().replace('\n', "; "));
            Error::new(&codes::BAD_JOINT_FILE, message)
        })?;
        Ok(Self { actuator: actuator(file)?, ..joint })
    }
}

/// The actuator of a joint that reports no torque; `None` of one that does.
fn actuator(file: &crate::joint::Joint) -> Result<Option<Actuator>> {
    let kind = file.actuator.kind;
    if kind == Kind::Torque {
        return Ok(None);
    }
    let partial = Partial::of(kind, &file.actuator.constants);
    let lacks_kp = kind == Kind::PositionServo && !file.actuator.constants.contains_key(&Constant::FirmwareKp);
    let lacking = partial.lacking(kind.is_motor()).or(lacks_kp.then_some(Constant::FirmwareKp));
    match lacking {
        None => Ok(Some(partial.actuator)),
        Some(constant) => {
            let message =
                format!("to simulate an actuator of kind `{}` its `{}` has to be known", kind.name(), constant.key());
            Err(Error::new(&codes::MISSING_PARAMETER, message).in_column(format!("actuator.{}", constant.key())))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plant::{Friction, Hidden};

    fn parse(text: &str) -> Result<Joint> {
        Joint::described_by(&crate::joint::Joint::parse(text).unwrap())
    }

    #[test]
    fn every_key_is_optional_and_the_default_survives_a_round_trip() {
        assert_eq!(parse("").unwrap(), Joint::default());
        let text = toml::to_string(&Joint::default()).unwrap();
        assert_eq!(toml::from_str::<Joint>(&text).unwrap(), Joint::default());
    }

    #[test]
    fn the_plant_inherits_what_the_rest_of_the_file_knows() {
        let text = "[rigid_body]\ninertia_kgm2 = 0.7\ngravity_torque_Nm = 3.0\n[drive]\ngear_ratio = 50.0\n\
                    [plant.drive]\nrate_Hz = 2000.0\n[plant.friction]\ncoulomb_torque_Nm = 1.0\n\
                    [[plant.effects]]\nname = \"stribeck\"\namplitude = 0.5\n";
        let joint = parse(text).unwrap();
        assert_eq!(joint.inertia_kgm2, 0.7);
        assert_eq!(joint.gravity_torque_nm, [3.0]);
        assert_eq!((joint.drive.gear_ratio, joint.drive.rate_hz), (50.0, 2000.0));
        assert_eq!(joint.friction, Friction { coulomb_torque_nm: 1.0, ..Friction::default() });
        assert_eq!(joint.effects, [Hidden { name: "stribeck".into(), amplitude: 0.5 }]);
    }

    #[test]
    fn an_actuator_has_to_be_known_to_be_simulated() {
        let known = parse("[actuator]\nkind = \"pd\"\nkp_Nm_rad = 40\nkd_Nms_rad = 1.5\n").unwrap();
        assert_eq!(known.actuator.map(|actuator| (actuator.kp, actuator.kd)), Some((40.0, 1.5)));
        let open = parse("[actuator]\nkind = \"pd\"\nkp_Nm_rad = 40\n").unwrap_err();
        assert_eq!((open.code(), open.column()), (&codes::MISSING_PARAMETER, Some("actuator.kd_Nms_rad")));
        let servo = "[actuator]\nkind = \"position_servo\"\ntorque_per_volt_Nm_V = 0.1\nfirmware_error_gain = 0.003\nfirmware_kp = 400\n";
        assert_eq!(parse(servo).unwrap_err().column(), Some("actuator.supply_V"));
        assert!(parse("").unwrap().actuator.is_none());
    }

    #[test]
    fn a_misspelt_key_is_refused_by_name() {
        let error = parse("[plant]\ninertia = 0.5\n").unwrap_err();
        assert!(error.to_string().contains("inertia"), "{error}");
    }
}
