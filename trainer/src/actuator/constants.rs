//! The constants of an actuator: what each means, and how far it is known.

use std::collections::BTreeMap;
use std::fmt;

use serde::de::{Error as _, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};

/// A constant of an actuator. Torques and speeds are those of the joint, behind the gear.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Constant {
    /// Torque per current, N m/A, and voltage per speed, V s/rad, which is the same number.
    TorqueConstant,
    /// Resistance of winding and leads, ohm.
    Resistance,
    /// Torque per voltage at rest, N m/V: torque constant over resistance, where these are not known each by itself.
    TorquePerVolt,
    /// Torque lost per velocity, N m s/rad: torque constant squared over resistance. Without any of the three it is counted as viscous
    /// friction.
    BackEmf,
    /// Supply voltage, V, where no column has it.
    Supply,
    /// Resistance between the supply and where its voltage is known, ohm: the voltage sags with the load.
    SupplyResistance,
    /// Largest duty, 0 to 1.
    DutyLimit,
    /// Torque per position error, N m/rad.
    Kp,
    /// Torque per velocity error, N m s/rad.
    Kd,
    /// Gain as the firmware counts it.
    FirmwareKp,
    /// Duty per rad of position error and unit of the firmware's gain.
    FirmwareErrorGain,
    /// Largest torque, N m.
    TorqueLimit,
    /// Position error up to which nothing happens, rad.
    DeadBand,
    /// Time from the command to its effect, s.
    Delay,
    /// Time from the motion to what a controller makes of it, s.
    FeedbackDelay,
    /// Speed at which the firmware lets the reference move at most, rad/s.
    VelocityLimit,
}

impl Constant {
    /// Every constant, in the order of the variants.
    pub const ALL: [Self; 16] = [
        Self::TorqueConstant,
        Self::Resistance,
        Self::TorquePerVolt,
        Self::BackEmf,
        Self::Supply,
        Self::SupplyResistance,
        Self::DutyLimit,
        Self::Kp,
        Self::Kd,
        Self::FirmwareKp,
        Self::FirmwareErrorGain,
        Self::TorqueLimit,
        Self::DeadBand,
        Self::Delay,
        Self::FeedbackDelay,
        Self::VelocityLimit,
    ];

    /// Its key in joint.toml.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::TorqueConstant => "torque_constant_Nm_A",
            Self::Resistance => "resistance_ohm",
            Self::TorquePerVolt => "torque_per_volt_Nm_V",
            Self::BackEmf => "back_emf_Nms_rad",
            Self::Supply => "supply_V",
            Self::SupplyResistance => "supply_resistance_ohm",
            Self::DutyLimit => "duty_limit",
            Self::Kp => "kp_Nm_rad",
            Self::Kd => "kd_Nms_rad",
            Self::FirmwareKp => "firmware_kp",
            Self::FirmwareErrorGain => "firmware_error_gain",
            Self::TorqueLimit => "torque_limit_Nm",
            Self::DeadBand => "dead_band_rad",
            Self::Delay => "delay_s",
            Self::FeedbackDelay => "feedback_delay_s",
            Self::VelocityLimit => "velocity_limit_rad_s",
        }
    }

    /// What it is, in a few words; its unit is in its key.
    #[must_use]
    pub fn meaning(self) -> &'static str {
        match self {
            Self::TorqueConstant => "torque per current, behind the gear",
            Self::Resistance => "of winding and leads",
            Self::TorquePerVolt => "torque constant over resistance, where only their quotient is known",
            Self::BackEmf => "torque lost per velocity",
            Self::Supply => "supply voltage, where no column has it",
            Self::SupplyResistance => "between the supply and where its voltage is known",
            Self::DutyLimit => "largest duty, 0 to 1",
            Self::Kp => "torque per position error",
            Self::Kd => "torque per velocity error",
            Self::FirmwareKp => "gain as the firmware counts it, where no column kp has it",
            Self::FirmwareErrorGain => "duty per rad of position error and unit of the firmware's gain",
            Self::TorqueLimit => "largest torque",
            Self::DeadBand => "position error up to which nothing happens",
            Self::Delay => "from the command to its effect",
            Self::FeedbackDelay => {
                "from the motion to what the controller makes of it: its period and a half, and the filter of its velocity"
            }
            Self::VelocityLimit => "speed at which the reference moves at most",
        }
    }

    /// The rule that a value has to keep, for messages.
    #[must_use]
    pub fn rule(self) -> &'static str {
        match self {
            Self::DutyLimit => "this has to lie above 0 and not above 1",
            Self::Delay | Self::FeedbackDelay => "this has to lie between 0 and 1 s",
            _ if self.may_be_zero() => "this has to be a finite number, zero or above",
            _ => "this has to be a finite number above zero",
        }
    }

    /// Whether an actuator can have it.
    #[must_use]
    pub fn allows(self, value: f64) -> bool {
        let most = if matches!(self, Self::DutyLimit | Self::Delay | Self::FeedbackDelay) { 1.0 } else { f64::MAX };
        value <= most && (value > 0.0 || value == 0.0 && self.may_be_zero())
    }

    fn may_be_zero(self) -> bool {
        use Constant::{BackEmf, DeadBand, Delay, FeedbackDelay, Kd, Kp, SupplyResistance};
        matches!(self, BackEmf | SupplyResistance | Kp | Kd | DeadBand | Delay | FeedbackDelay)
    }
}

/// How far a constant is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Known {
    /// Its value.
    Given(f64),
    /// It lies between these.
    Between(f64, f64),
}

impl Known {
    /// The value that is given.
    #[must_use]
    pub fn given(self) -> Option<f64> {
        match self {
            Self::Given(value) => Some(value),
            Self::Between(..) => None,
        }
    }

    /// The value, or the middle of what it may be: geometric, for such constants are known up to a factor.
    #[must_use]
    pub fn start(self) -> f64 {
        match self {
            Self::Given(value) => value,
            Self::Between(low, high) if low > 0.0 => (low * high).sqrt(),
            Self::Between(low, high) => 0.5 * (low + high),
        }
    }
}

/// What is known of an actuator's constants; the rest is identified.
pub type Constants = BTreeMap<Constant, Known>;

impl<'de> Deserialize<'de> for Known {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberOrPair)
    }
}

struct NumberOrPair;

impl<'de> Visitor<'de> for NumberOrPair {
    type Value = Known;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a number, or [lowest, highest]")
    }

    fn visit_f64<E>(self, value: f64) -> Result<Known, E> {
        Ok(Known::Given(value))
    }

    fn visit_i64<E>(self, value: i64) -> Result<Known, E> {
        Ok(Known::Given(value as f64))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Known, A::Error> {
        let (low, high) = (sequence.next_element()?, sequence.next_element()?);
        match (low, high, sequence.next_element::<f64>()?) {
            (Some(low), Some(high), None) if low < high => Ok(Known::Between(low, high)),
            _ => Err(A::Error::custom("bounds are [lowest, highest], two numbers in that order")),
        }
    }
}
