//! The kinds of actuators.

use serde::Deserialize;

use super::constants::Constant;

/// What an actuator does with what it is told.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// The torque, force or current column is what acts on the joint.
    #[default]
    Torque,
    /// A current, times a torque constant.
    Current,
    /// A DC motor under a duty or a voltage, inductance neglected: torque = k/R (u - k v).
    DcMotor,
    /// A joint controller: torque = kp (reference - position) + kd (reference velocity - velocity) + feed-forward.
    Pd,
    /// A DC motor under a duty that the firmware makes from a position error.
    PositionServo,
}

impl Kind {
    /// Its name in joint.toml.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Torque => "torque",
            Self::Current => "current",
            Self::DcMotor => "dc_motor",
            Self::Pd => "pd",
            Self::PositionServo => "position_servo",
        }
    }

    /// Whether a voltage drives a motor.
    #[must_use]
    pub fn is_motor(self) -> bool {
        matches!(self, Self::DcMotor | Self::PositionServo)
    }

    /// Whether it follows a position reference.
    #[must_use]
    pub fn follows_position(self) -> bool {
        matches!(self, Self::Pd | Self::PositionServo)
    }

    /// The constants that it has.
    #[must_use]
    pub fn constants(self) -> &'static [Constant] {
        use Constant::{
            BackEmf, DeadBand, Delay, DutyLimit, FeedbackDelay, FirmwareErrorGain, FirmwareKp, Kd, Kp, Resistance,
            Supply, SupplyResistance, TorqueConstant, TorqueLimit, TorquePerVolt, VelocityLimit,
        };
        match self {
            Self::Torque => &[Delay],
            Self::Current => &[TorqueConstant, TorqueLimit, Delay],
            Self::DcMotor => &[
                TorqueConstant,
                Resistance,
                TorquePerVolt,
                BackEmf,
                Supply,
                SupplyResistance,
                DutyLimit,
                TorqueLimit,
                Delay,
            ],
            Self::Pd => &[Kp, Kd, TorqueLimit, DeadBand, Delay, FeedbackDelay, VelocityLimit],
            Self::PositionServo => &[
                TorqueConstant,
                Resistance,
                TorquePerVolt,
                BackEmf,
                Supply,
                SupplyResistance,
                DutyLimit,
                TorqueLimit,
                FirmwareKp,
                FirmwareErrorGain,
                DeadBand,
                Delay,
                FeedbackDelay,
                VelocityLimit,
            ],
        }
    }
}
