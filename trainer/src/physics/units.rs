//! Units as they are printed: of an actuator, of channels, and of parameters.

use crate::physics::Dimension;

/// What the recording is measured in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Units {
    /// Unit of the actuator as printed: `N m`, `N` or `A`.
    pub actuator: &'static str,
    /// Whether the axis turns (else it slides).
    pub rotary: bool,
}

impl Units {
    /// Unit of a channel or derived axis, as printed.
    #[must_use]
    pub fn of_channel(self, channel: &str) -> String {
        let position = if self.rotary { "rad" } else { "m" };
        match channel {
            "velocity" | "other_velocity" => format!("{position}/s"),
            "position" | "other_position" | "distance_since_reversal" => position.to_string(),
            "acceleration" => format!("{position}/s2"),
            "load" => self.actuator.to_string(),
            "temperature" => "degC".to_string(),
            "time" | "time_since_reversal" | "dwell" => "s".to_string(),
            _ => String::new(),
        }
    }
}

/// Text of a dimension's unit for an axis and an actuator unit ("N m", "N" or "A").
pub fn unit_text(dimension: Dimension, rotary: bool, actuator: &str) -> String {
    let position = if rotary { "rad" } else { "m" };
    match dimension {
        Dimension::Torque => actuator.to_string(),
        Dimension::TorquePerVelocity => format!("{actuator} s/{position}"),
        Dimension::TorquePerVelocityPower => format!("{actuator} (s/{position})^p"),
        Dimension::TorquePerKelvin => format!("{actuator}/K"),
        Dimension::PerKelvin => "1/K".to_string(),
        Dimension::TorquePerVelocityKelvin => format!("{actuator} s/({position} K)"),
        Dimension::TorquePerPosition => format!("{actuator}/{position}"),
        Dimension::Inertia => match (actuator, rotary) {
            ("N m", true) => "kg m2".to_string(),
            ("N", false) => "kg".to_string(),
            _ => format!("{actuator} s2/{position}"),
        },
        Dimension::InertiaPosition => match (actuator, rotary) {
            ("N m", true) => "kg m2".to_string(),
            ("N", false) => "kg m".to_string(),
            _ => format!("{actuator} s2"),
        },
        Dimension::Celsius => "degC".to_string(),
        Dimension::TorquePerSecond => format!("{actuator}/s"),
        Dimension::TorquePerSecondSquared => format!("{actuator}/s2"),
        Dimension::TorquePerWatt => format!("{actuator}/W"),
        Dimension::TorquePerWattVelocity => format!("{actuator} s/({position} W)"),
        Dimension::PerTorque => format!("1/({actuator})"),
        Dimension::Velocity => format!("{position}/s"),
        Dimension::Position => position.to_string(),
        Dimension::RadianPerSecond => "rad/s".to_string(),
        Dimension::Second => "s".to_string(),
        Dimension::TorquePerVelocitySquared => format!("{actuator} s2/{position}2"),
        Dimension::Order => if rotary { "1/turn" } else { "rad/m" }.to_string(),
        Dimension::One => "1".to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inertia_has_the_unit_of_its_axis_and_actuator() {
        let shown = |dimension| {
            [(true, "N m"), (false, "N"), (false, "N m"), (true, "A")]
                .map(|(rotary, actuator)| unit_text(dimension, rotary, actuator))
        };
        assert_eq!(shown(Dimension::Inertia), ["kg m2", "kg", "N m s2/m", "A s2/rad"]);
        assert_eq!(shown(Dimension::InertiaPosition), ["kg m2", "kg m", "N m s2", "A s2"]);
        assert_eq!(
            unit_text(Dimension::Celsius, true, "N m"),
            Units { actuator: "N m", rotary: true }.of_channel("temperature")
        );
    }
}
