//! A parameter file of BAM.

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use super::variant::{LoadFriction, Variant};
use crate::error::{Error, Result, codes};

/// Keys of the motor and its bench beside friction.
const OF_MOTOR: [&str; 8] =
    ["kt", "R", "armature", "command_delay", "q_offset", "error_gain_ratio", "max_velocity", "current_limit"];
/// Those that have to lie above zero.
const ABOVE_ZERO: [&str; 7] =
    ["kt", "R", "error_gain_ratio", "max_velocity", "current_limit", "dtheta_stribeck", "alpha"];

/// What BAM knows of a servo. Torques and speeds are those of the joint, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameters {
    /// Its friction model.
    pub variant: Variant,
    /// BAM's name of the actuator.
    pub actuator: String,
    values: BTreeMap<&'static str, f64>,
    /// Keys of the file that nothing is known of, or that its friction model does not have.
    pub left_out: Vec<String>,
}

impl Parameters {
    /// Parameters of a friction model, each by its key; those that it does not have are left out.
    #[must_use]
    pub fn new(variant: Variant, actuator: &str, values: impl IntoIterator<Item = (&'static str, f64)>) -> Self {
        Self { variant, actuator: actuator.to_owned(), values: values.into_iter().collect(), left_out: Vec::new() }
    }

    /// Whether a text is such a file: JSON with a friction model and an actuator.
    #[must_use]
    pub fn are_in(text: &str) -> bool {
        let json = serde_json::from_str::<Value>(text).unwrap_or_default();
        json.get("actuator").is_some_and(Value::is_string) && json.get("model").is_some_and(Value::is_string)
    }

    /// Reads a file.
    ///
    /// # Errors
    /// `FRK-D046` where it is no such file, names a friction model that does not exist, or lacks a parameter of it or has one that cannot be.
    pub fn parse(text: &str) -> Result<Self> {
        let bad = |message: String| Error::new(&codes::BAD_BAM_FILE, message);
        let json: Map<String, Value> = serde_json::from_str(text).map_err(|error| bad(format!("no JSON: {error}")))?;
        let word = |key: &str| {
            let value = json.get(key).and_then(Value::as_str);
            value.ok_or_else(|| bad(format!("`{key}` is not given")).in_column(key))
        };
        let (name, actuator) = (word("model")?, word("actuator")?);
        let variant = Variant::ALL.into_iter().find(|variant| variant.name() == name);
        let variant = variant.ok_or_else(|| {
            bad(format!("there are the friction models {}", Variant::ALL.map(Variant::name).join(", ")))
                .in_column("model")
                .with_value(name)
        })?;
        let of_friction = variant.keys();
        let mut values = BTreeMap::new();
        for key in of_friction.iter().copied().chain(OF_MOTOR) {
            let Some(value) = json.get(key) else {
                if of_friction.contains(&key) {
                    return Err(bad(format!("`{name}` has a parameter `{key}`, which is not given")).in_column(key));
                }
                continue;
            };
            let is_offset = key == "q_offset";
            let lowest = if ABOVE_ZERO.contains(&key) { f64::MIN_POSITIVE } else { 0.0 };
            let number = value.as_f64().filter(|number| number.is_finite() && (is_offset || *number >= lowest));
            let rule = if lowest > 0.0 {
                "this has to be a number above zero"
            } else {
                "this has to be a number, zero or above"
            };
            let number = number.ok_or_else(|| bad(rule.to_owned()).in_column(key).with_value(value.to_string()))?;
            values.insert(key, number);
        }
        let known = |key: &str| values.contains_key(key) || ["model", "actuator", "made_by"].contains(&key);
        let left_out = json.keys().filter(|key| !known(key.as_str())).cloned().collect();
        Ok(Self { variant, actuator: actuator.to_owned(), values, left_out })
    }

    /// The file, with a word on who made it.
    #[must_use]
    pub fn to_json(&self, made_by: &str) -> String {
        let mut json: Map<String, Value> = self.each().map(|(key, value)| (key.to_owned(), value.into())).collect();
        for (key, word) in [("model", self.variant.name()), ("actuator", &self.actuator), ("made_by", made_by)] {
            json.insert(key.to_owned(), word.into());
        }
        serde_json::to_string_pretty(&Value::Object(json)).unwrap_or_default() + "\n"
    }

    /// A parameter by its key.
    #[must_use]
    pub fn get(&self, key: &str) -> Option<f64> {
        self.values.get(key).copied()
    }

    /// A parameter of friction; 0 of one that the friction model does not have.
    #[must_use]
    pub fn friction(&self, key: &str) -> f64 {
        self.get(key).unwrap_or(0.0)
    }

    /// The same servo with other parameters, or more.
    #[must_use]
    pub fn with(mut self, values: impl IntoIterator<Item = (&'static str, f64)>) -> Self {
        self.values.extend(values);
        self
    }

    /// Every parameter with its key, those of friction first.
    pub fn each(&self) -> impl Iterator<Item = (&'static str, f64)> {
        let keys = self.variant.keys().into_iter().chain(OF_MOTOR);
        keys.filter_map(|key| Some((key, self.get(key)?)))
    }

    /// Friction, N m, in the sign of the velocity, rad/s, under the motor's torque and one from outside, N m, each along the positive
    /// direction (Duclusaud et al. 2024, as `compute_frictions` of BAM's `bam/model.py` has it).
    #[must_use]
    pub fn torque(&self, velocity: f64, motor: f64, external: f64) -> f64 {
        let of = |key: &str| self.friction(key);
        let peak = if self.variant.has_peak() {
            libm::exp(-libm::pow((velocity / of("dtheta_stribeck")).abs(), of("alpha")))
        } else {
            0.0
        };
        let carried = match self.variant.load() {
            None => 0.0,
            Some(LoadFriction::Gear) => {
                (of("load_friction_base") + of("load_friction_stribeck") * peak) * (external - motor).abs()
            }
            Some(LoadFriction::Directional) => {
                let share = |kind: &str| {
                    let [of_external, of_motor] =
                        ["external", "motor"].map(|side| of(&format!("load_friction_{side}{kind}")));
                    (of_external * external - of_motor * motor).abs()
                };
                let squared = match (external * motor < 0.0, external.abs() < motor.abs()) {
                    (false, _) => 0.0,
                    (true, true) => of("load_friction_external_quad") * external * external,
                    (true, false) if external.abs() == motor.abs() => 0.0,
                    (true, false) => of("load_friction_motor_quad") * motor * motor,
                };
                share("") + peak * (share("_stribeck") + squared)
            }
        };
        let dry = of("friction_base") + of("friction_stribeck") * peak + carried;
        if velocity == 0.0 { 0.0 } else { dry.copysign(velocity) + of("friction_viscous") * velocity }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_file_lacks_or_cannot_have_is_refused_by_name() {
        for (text, column) in [
            ("[1]", None),
            ("{\"actuator\": \"xl330\"}", Some("model")),
            ("{\"actuator\": \"xl330\", \"model\": \"m7\"}", Some("model")),
            ("{\"actuator\": \"xl330\", \"model\": \"m1\", \"friction_base\": 0.1}", Some("friction_viscous")),
            (
                "{\"actuator\": \"xl330\", \"model\": \"m1\", \"friction_base\": -0.1, \"friction_viscous\": 0}",
                Some("friction_base"),
            ),
            (
                "{\"actuator\": \"a\", \"model\": \"m1\", \"friction_base\": 0, \"friction_viscous\": 0, \"kt\": 0}",
                Some("kt"),
            ),
        ] {
            let error = Parameters::parse(text).unwrap_err();
            assert_eq!((error.code(), error.column()), (&codes::BAD_BAM_FILE, column), "{text}: {error}");
        }
    }

    #[test]
    fn a_parameter_of_another_friction_model_is_told_and_not_used() {
        let text = "{\"actuator\": \"xl330\", \"model\": \"m1\", \"friction_base\": 0.1, \"friction_viscous\": 0.02, \"load_friction_base\": 0.3, \"vin\": 5, \"made_by\": \"\"}";
        assert!(Parameters::are_in(text) && !Parameters::are_in("time_s,position_rad\n0,1\n"));
        let parameters = Parameters::parse(text).unwrap();
        assert_eq!(parameters.left_out, ["load_friction_base", "vin"]);
        assert!((parameters.torque(-2.0, 5.0, 1.0) + 0.14).abs() < 1e-15);
        assert_eq!(parameters.torque(0.0, 5.0, 1.0), 0.0);
    }

    /// Against figures worked out by hand: load_friction of 0.2 of the motor and 0.1 of the outside, at rest 0.4 and 0.3 more, and squares.
    #[test]
    fn torques_that_oppose_each_other_add_friction() {
        let parameters = Parameters::new(
            Variant::M6,
            "xl330",
            [
                ("friction_base", 0.01),
                ("friction_viscous", 0.0),
                ("friction_stribeck", 0.02),
                ("dtheta_stribeck", 0.5),
                ("alpha", 1.0),
                ("load_friction_motor", 0.2),
                ("load_friction_external", 0.1),
                ("load_friction_motor_stribeck", 0.4),
                ("load_friction_external_stribeck", 0.3),
                ("load_friction_motor_quad", 0.5),
                ("load_friction_external_quad", 0.7),
            ],
        );
        let peak = (-2.0_f64).exp();
        let holds = parameters.torque(1.0, 1.0, -0.8);
        assert!((holds - (0.01 + 0.28 + peak * (0.02 + 0.64 + 0.7 * 0.64))).abs() < 1e-15);
        let is_driven = parameters.torque(1.0, 0.8, -1.0);
        assert!((is_driven - (0.01 + 0.26 + peak * (0.02 + 0.62 + 0.5 * 0.64))).abs() < 1e-15);
        let alike = parameters.torque(1.0, 1.0, 0.8);
        assert!((alike - (0.01 + 0.12 + peak * (0.02 + 0.16))).abs() < 1e-15);
    }
}
