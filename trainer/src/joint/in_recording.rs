//! A joint in one of its recordings, and what no actuator or payload can be.

use super::Joint;
use crate::actuator::{Constant, Known};
use crate::error::{Error, Result, codes};

impl Joint {
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
    use crate::actuator::Kind;

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
