//! What a column measures: the quantities of the contract and the unit suffixes that each understands.

use std::f64::consts::{PI, TAU};

/// A quantity that a recording may hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Quantity {
    /// Time of the sample, s.
    Time,
    /// Joint position, rad or m.
    Position,
    /// Joint velocity, rad/s or m/s.
    Velocity,
    /// Joint acceleration, rad/s2 or m/s2.
    Acceleration,
    /// Actuator torque at the joint, N m.
    Torque,
    /// Actuator force, N.
    Force,
    /// Motor current, A.
    Current,
    /// Friction already separated, N m.
    FrictionTorque,
    /// Friction already separated, N.
    FrictionForce,
    /// Torque of a rigid-body model along the motion, in the unit of the actuator.
    RigidBodyTorque,
    /// Torque transmitted through the gear, N m or N.
    LoadTorque,
    /// Temperature, degrees Celsius.
    Temperature,
    /// Position on the link side of the gear, rad or m.
    LinkPosition,
    /// Commanded position, rad or m.
    ReferencePosition,
    /// Voltage, V.
    Voltage,
}

/// Which kind of axis a unit belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// Angles: rad, N m.
    Rotary,
    /// Lengths: m, N.
    Linear,
}

/// A unit suffix with its way to SI: `si = value * factor + offset`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Suffix as it stands in a column name.
    pub suffix: &'static str,
    /// SI unit (degree Celsius for temperatures), as it is printed.
    pub si: &'static str,
    /// Factor to SI; for `count` and motor-side columns the drive's parameters come on top.
    pub factor: f64,
    /// Offset to SI, added after the factor.
    pub offset: f64,
    /// Axis that the unit implies, if any.
    pub axis: Option<Axis>,
}

const fn unit(suffix: &'static str, si: &'static str, factor: f64) -> Unit {
    Unit { suffix, si, factor, offset: 0.0, axis: None }
}

const fn rotary(suffix: &'static str, si: &'static str, factor: f64) -> Unit {
    Unit { suffix, si, factor, offset: 0.0, axis: Some(Axis::Rotary) }
}

const fn linear(suffix: &'static str, si: &'static str, factor: f64) -> Unit {
    Unit { suffix, si, factor, offset: 0.0, axis: Some(Axis::Linear) }
}

const DEGREE: f64 = PI / 180.0;

const TIMES: &[Unit] = &[unit("s", "s", 1.0), unit("ms", "s", 1e-3), unit("us", "s", 1e-6), unit("ns", "s", 1e-9)];
const POSITIONS: &[Unit] = &[
    rotary("rad", "rad", 1.0),
    rotary("mrad", "rad", 1e-3),
    rotary("deg", "rad", DEGREE),
    rotary("turn", "rad", TAU),
    rotary("count", "rad", TAU),
    linear("m", "m", 1.0),
    linear("mm", "m", 1e-3),
    linear("um", "m", 1e-6),
];
const VELOCITIES: &[Unit] = &[
    rotary("rad_s", "rad/s", 1.0),
    rotary("deg_s", "rad/s", DEGREE),
    rotary("rpm", "rad/s", TAU / 60.0),
    rotary("turn_s", "rad/s", TAU),
    rotary("count_s", "rad/s", TAU),
    linear("m_s", "m/s", 1.0),
    linear("mm_s", "m/s", 1e-3),
    linear("um_s", "m/s", 1e-6),
];
const ACCELERATIONS: &[Unit] = &[
    rotary("rad_s2", "rad/s2", 1.0),
    rotary("deg_s2", "rad/s2", DEGREE),
    rotary("turn_s2", "rad/s2", TAU),
    linear("m_s2", "m/s2", 1.0),
    linear("mm_s2", "m/s2", 1e-3),
];
const TORQUES: &[Unit] =
    &[unit("Nm", "Nm", 1.0), unit("mNm", "Nm", 1e-3), unit("uNm", "Nm", 1e-6), unit("kNm", "Nm", 1e3)];
const FORCES: &[Unit] = &[unit("N", "N", 1.0), unit("mN", "N", 1e-3), unit("uN", "N", 1e-6), unit("kN", "N", 1e3)];
const CURRENTS: &[Unit] = &[unit("A", "A", 1.0), unit("mA", "A", 1e-3)];
const LOADS: &[Unit] = &[
    unit("Nm", "Nm", 1.0),
    unit("mNm", "Nm", 1e-3),
    unit("uNm", "Nm", 1e-6),
    unit("kNm", "Nm", 1e3),
    unit("N", "N", 1.0),
    unit("mN", "N", 1e-3),
    unit("uN", "N", 1e-6),
    unit("kN", "N", 1e3),
    unit("A", "A", 1.0),
    unit("mA", "A", 1e-3),
];
const TEMPERATURES: &[Unit] = &[
    unit("C", "C", 1.0),
    unit("degC", "C", 1.0),
    Unit { suffix: "K", si: "C", factor: 1.0, offset: -273.15, axis: None },
];
const VOLTAGES: &[Unit] = &[unit("V", "V", 1.0), unit("mV", "V", 1e-3)];

/// Other ways to write a unit, with its suffix.
const WRITTEN_UNITS: &[(&str, &str)] = &[
    ("sec", "s"),
    ("seconds", "s"),
    ("msec", "ms"),
    ("usec", "us"),
    ("nsec", "ns"),
    ("radians", "rad"),
    ("degrees", "deg"),
    ("degree", "deg"),
    ("rev", "turn"),
    ("turns", "turn"),
    ("counts", "count"),
    ("radians_s", "rad_s"),
    ("rad_sec", "rad_s"),
    ("degrees_s", "deg_s"),
    ("deg_sec", "deg_s"),
    ("rev_s", "turn_s"),
    ("rev_min", "rpm"),
    ("RPM", "rpm"),
    ("counts_s", "count_s"),
    ("N-m", "Nm"),
    ("amps", "A"),
    ("volts", "V"),
];

/// Words that follow a quantity in column names of flags and registers: no misspelt units.
const FLAGS: &[&str] =
    &["enabled", "valid", "flag", "state", "status", "mode", "register", "raw", "id", "index", "limit", "error"];

impl Quantity {
    /// Quantity and unit of a column `<quantity>_<unit>`.
    #[must_use]
    pub fn of_column(name: &str) -> Option<(Self, &'static Unit)> {
        match read_column_name(name) {
            ColumnName::Known(quantity, unit) => Some((quantity, unit)),
            ColumnName::UnknownUnit(_) | ColumnName::Other => None,
        }
    }

    /// Every quantity with its name in column names.
    pub const ALL: [(Self, &'static str); 15] = [
        (Self::Time, "time"),
        (Self::Position, "position"),
        (Self::Velocity, "velocity"),
        (Self::Acceleration, "acceleration"),
        (Self::Torque, "torque"),
        (Self::Force, "force"),
        (Self::Current, "current"),
        (Self::FrictionTorque, "friction_torque"),
        (Self::FrictionForce, "friction_force"),
        (Self::RigidBodyTorque, "rigid_body_torque"),
        (Self::LoadTorque, "load_torque"),
        (Self::Temperature, "temperature"),
        (Self::LinkPosition, "link_position"),
        (Self::ReferencePosition, "reference_position"),
        (Self::Voltage, "voltage"),
    ];

    /// Name in column names, in `[columns]` and as an input of a model.
    #[must_use]
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(quantity, _)| *quantity == self).map_or("", |(_, name)| name)
    }

    /// The quantity of this name; `load` is short for `load_torque`.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let name = if name == "load" { "load_torque" } else { name };
        Self::ALL.iter().find(|(_, known)| *known == name).map(|(quantity, _)| *quantity)
    }

    /// Units that the quantity understands.
    #[must_use]
    pub fn units(self) -> &'static [Unit] {
        match self {
            Self::Time => TIMES,
            Self::Position | Self::LinkPosition | Self::ReferencePosition => POSITIONS,
            Self::Velocity => VELOCITIES,
            Self::Acceleration => ACCELERATIONS,
            Self::Torque | Self::FrictionTorque => TORQUES,
            Self::Force | Self::FrictionForce => FORCES,
            Self::Current => CURRENTS,
            Self::RigidBodyTorque | Self::LoadTorque => LOADS,
            Self::Temperature => TEMPERATURES,
            Self::Voltage => VOLTAGES,
        }
    }

    /// The unit of this suffix; `deg/s`, `rad/s^2`, `N m` and `seconds` are taken for `deg_s`, `rad_s2`, `Nm` and `s`.
    #[must_use]
    pub fn unit(self, suffix: &str) -> Option<&'static Unit> {
        let letters = suffix.replace('²', "2").replace("°C", "C").replace('°', "deg");
        let plain: String = letters.chars().filter(|c| !matches!(c, ' ' | '^' | '·' | '*' | '.')).collect();
        let plain = plain.replace('/', "_");
        let known = |name: &str| self.units().iter().find(|unit| unit.suffix == name);
        let written =
            || WRITTEN_UNITS.iter().find(|(written, _)| *written == plain).and_then(|(_, suffix)| known(suffix));
        known(&plain).or_else(written)
    }

    /// The suffixes that the quantity understands, for messages.
    #[must_use]
    pub fn suffixes(self) -> String {
        self.units().iter().map(|unit| unit.suffix).collect::<Vec<_>>().join(" ")
    }
}

/// What the name of a column says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ColumnName {
    /// `<quantity>_<unit>` as understood.
    Known(Quantity, &'static Unit),
    /// A quantity without unit or with one that it does not understand.
    UnknownUnit(Quantity),
    /// Anything else: a named channel.
    Other,
}

/// Reads `<quantity>_<unit>`.
pub(super) fn read_column_name(name: &str) -> ColumnName {
    for (quantity, prefix) in Quantity::ALL {
        if name == prefix {
            return ColumnName::UnknownUnit(quantity);
        }
        let Some(suffix) = name.strip_prefix(prefix).and_then(|rest| rest.strip_prefix('_')) else { continue };
        if let Some(unit) = quantity.unit(suffix) {
            return ColumnName::Known(quantity, unit);
        }
        // Any suffix that some quantity understands is a unit in the wrong place; of the rest, a single word that
        // is not a usual flag is taken for a misspelt or foreign unit.
        let unit_elsewhere = Quantity::ALL.iter().any(|(other, _)| other.unit(suffix).is_some());
        if unit_elsewhere || (!suffix.contains('_') && !FLAGS.contains(&suffix)) {
            return ColumnName::UnknownUnit(quantity);
        }
    }
    ColumnName::Other
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contract_names_are_read() {
        for (name, quantity, factor) in [
            ("time_ms", Quantity::Time, 1e-3),
            ("position_rad", Quantity::Position, 1.0),
            ("velocity_rpm", Quantity::Velocity, TAU / 60.0),
            ("friction_force_uN", Quantity::FrictionForce, 1e-6),
            ("rigid_body_torque_A", Quantity::RigidBodyTorque, 1.0),
            ("link_position_rad", Quantity::LinkPosition, 1.0),
            ("position_mm", Quantity::Position, 1e-3),
        ] {
            match read_column_name(name) {
                ColumnName::Known(found, unit) => {
                    assert_eq!(found, quantity);
                    assert!((unit.factor - factor).abs() <= 1e-15 * factor, "{name}");
                }
                other => panic!("{name}: {other:?}"),
            }
        }
    }

    #[test]
    fn foreign_names_are_channels_and_foreign_units_are_seen() {
        for name in ["reference_m", "torque_enabled", "load_register", "normal_force_uN", "goal_position_rad"] {
            assert_eq!(read_column_name(name), ColumnName::Other, "{name}");
        }
        for name in ["velocity", "velocity_mph", "torque_rad_s", "position_inch"] {
            assert!(matches!(read_column_name(name), ColumnName::UnknownUnit(_)), "{name}");
        }
    }

    #[test]
    fn written_units_are_the_same_as_suffixes() {
        assert_eq!(Quantity::Acceleration.unit("rad/s^2").unwrap().suffix, "rad_s2");
        assert_eq!(Quantity::Torque.unit("N·m").unwrap().suffix, "Nm");
        assert_eq!(Quantity::Position.unit("°").unwrap().suffix, "deg");
        for (written, suffix) in WRITTEN_UNITS {
            assert!(
                Quantity::ALL.iter().any(|(quantity, _)| quantity.unit(written) == quantity.unit(suffix)),
                "{written}"
            );
        }
    }
}
