//! An actuator as far as its constants are known, and what a recording has to tell of it.

use super::applied::{Actuator, Limits};
use super::constants::{Constant, Constants, Known};
use super::kind::Kind;
use crate::numerics::Number;

/// A constant in which the torque is linear and that is not given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Open {
    /// Torque per current, or per voltage.
    Gain,
    /// Torque per position error.
    Kp,
    /// Torque per velocity error.
    Kd,
}

impl Open {
    /// The constant that says it of an actuator of a kind.
    #[must_use]
    pub fn constant(self, kind: Kind) -> Constant {
        match (self, kind) {
            (Self::Gain, Kind::Current) => Constant::TorqueConstant,
            (Self::Gain, _) => Constant::TorquePerVolt,
            (Self::Kp, _) => Constant::Kp,
            (Self::Kd, _) => Constant::Kd,
        }
    }
}

impl Open {
    /// Where identification starts, by what is known of the constants: a value, or the middle of bounds. `None` where nothing is.
    #[must_use]
    pub fn start(self, kind: Kind, constants: &Constants) -> Option<f64> {
        let start = |constant| constants.get(&constant).copied().map(Known::start);
        let of_both = || Some(start(Constant::TorqueConstant)? / start(Constant::Resistance)?);
        match self {
            Self::Gain if kind.is_motor() => start(Constant::TorquePerVolt).or_else(of_both),
            Self::Gain | Self::Kp | Self::Kd => start(self.constant(kind)),
        }
    }
}

/// An actuator of which some constants may be open; those are at the middle of their bounds, or at 1.
#[derive(Clone, Debug, PartialEq)]
pub struct Partial {
    /// The actuator.
    pub actuator: Actuator,
    /// What is not given.
    pub open: Vec<Open>,
    torque_constant: Option<f64>,
    resistance: Option<f64>,
}

impl Partial {
    /// What `constants` say of an actuator of a kind. The firmware's constants, limits, supply, dead band and delay that are bounded are
    /// taken at the middle of their bounds.
    #[must_use]
    pub fn of(kind: Kind, constants: &Constants) -> Self {
        let given = |constant| constants.get(&constant).copied().and_then(Known::given);
        let start = |constant, otherwise| constants.get(&constant).copied().map_or(otherwise, Known::start);
        let (torque_constant, resistance) = (given(Constant::TorqueConstant), given(Constant::Resistance));
        let mut actuator = Actuator {
            kp: start(if kind == Kind::Pd { Constant::Kp } else { Constant::FirmwareKp }, 1.0),
            kd: start(Constant::Kd, 0.0),
            error_gain: start(Constant::FirmwareErrorGain, 0.0),
            dead_band: start(Constant::DeadBand, 0.0),
            supply: start(Constant::Supply, f64::NAN),
            delay_s: start(Constant::Delay, 0.0),
            feedback_delay_s: start(Constant::FeedbackDelay, 0.0),
            velocity_limit: start(Constant::VelocityLimit, f64::INFINITY),
            limits: Limits {
                duty: start(Constant::DutyLimit, 1.0),
                torque: start(Constant::TorqueLimit, f64::INFINITY),
            },
            ..Actuator::ideal(kind)
        };
        let mut open = Vec::new();
        match kind {
            Kind::Torque => {}
            Kind::Current => match torque_constant {
                Some(constant) => actuator.gain = constant,
                None => open.push(Open::Gain),
            },
            Kind::DcMotor | Kind::PositionServo => {
                let of_both = torque_constant.zip(resistance).map(|(constant, resistance)| constant / resistance);
                match given(Constant::TorquePerVolt).or(of_both) {
                    Some(gain) => actuator.gain = gain,
                    None => open.push(Open::Gain),
                }
                let winding = start(Constant::Resistance, 0.0);
                if winding > 0.0 {
                    actuator.sag = start(Constant::SupplyResistance, 0.0) / winding;
                }
            }
            Kind::Pd => {
                open.extend(given(Constant::Kp).is_none().then_some(Open::Kp));
                open.extend(given(Constant::Kd).is_none().then_some(Open::Kd));
            }
        }
        let mut partial = Self { actuator, open, torque_constant, resistance };
        partial.actuator.back_emf = given(Constant::BackEmf).unwrap_or_else(|| partial.back_emf(partial.actuator.gain));
        partial
    }

    /// What has to be known to simulate it and is not, its supply where that is asked for.
    #[must_use]
    pub fn lacking(&self, needs_supply: bool) -> Option<Constant> {
        let actuator = &self.actuator;
        let lacks_error_gain = actuator.kind == Kind::PositionServo && actuator.error_gain <= 0.0;
        let open = self.open.first().map(|open| open.constant(actuator.kind));
        open.or((needs_supply && actuator.supply.is_nan()).then_some(Constant::Supply))
            .or(lacks_error_gain.then_some(Constant::FirmwareErrorGain))
    }

    /// The same with a value for what is open.
    #[must_use]
    pub fn with(self, open: Open, value: f64) -> Self {
        let actuator = self.completed(self.actuator, open, value);
        Self { actuator, ..self }
    }

    /// Its actuator in other numbers, with a value for what is open.
    #[must_use]
    pub(crate) fn completed<T: Number>(&self, mut actuator: Actuator<T>, open: Open, value: T) -> Actuator<T> {
        match open {
            Open::Gain => {
                actuator.gain = value;
                // A loss that was given as such stays.
                if self.actuator.back_emf == self.back_emf(self.actuator.gain) {
                    actuator.back_emf = self.back_emf(value);
                }
            }
            Open::Kp => actuator.kp = value,
            Open::Kd => actuator.kd = value,
        }
        actuator
    }

    /// Torque that a motor of so much torque per voltage loses per velocity as far as torque constant or resistance tell it, N m s/rad; else
    /// it counts as viscous friction.
    fn back_emf<T: Number>(&self, gain: T) -> T {
        match (self.actuator.kind.is_motor(), self.torque_constant, self.resistance) {
            (true, Some(constant), _) => gain * constant,
            (true, None, Some(resistance)) => gain * gain * resistance,
            _ => T::zero(),
        }
    }

    /// Whether the loss by back-EMF is part of the viscous friction, since nothing tells it.
    #[must_use]
    pub fn counts_back_emf_as_friction(&self) -> bool {
        self.actuator.kind.is_motor() && self.actuator.back_emf == 0.0
    }

    /// The constants that say all of the actuator, for joint.toml: key and value.
    #[must_use]
    pub fn in_force(&self) -> Vec<(Constant, f64)> {
        let actuator = &self.actuator;
        let mut constants = match actuator.kind {
            Kind::Torque => Vec::new(),
            Kind::Current => vec![(Constant::TorqueConstant, actuator.gain)],
            Kind::DcMotor | Kind::PositionServo => {
                vec![(Constant::TorquePerVolt, actuator.gain), (Constant::BackEmf, actuator.back_emf)]
            }
            Kind::Pd => vec![(Constant::Kp, actuator.kp), (Constant::Kd, actuator.kd)],
        };
        constants.push((Constant::Delay, actuator.delay_s));
        let late = actuator.feedback_delay_s;
        constants.extend((late > 0.0).then_some((Constant::FeedbackDelay, late)));
        constants.extend(actuator.limits.torque.is_finite().then_some((Constant::TorqueLimit, actuator.limits.torque)));
        constants
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn partial(kind: Kind, given: &[(Constant, f64)]) -> Partial {
        Partial::of(kind, &given.iter().map(|(constant, value)| (*constant, Known::Given(*value))).collect())
    }

    #[test]
    fn what_is_not_given_is_open() {
        use Constant::{BackEmf, Kp, Resistance, TorqueConstant, TorquePerVolt};
        let motor = partial(Kind::DcMotor, &[(TorqueConstant, 0.3), (Resistance, 3.0)]);
        assert!((motor.actuator.gain - 0.1).abs() < 1e-15 && (motor.actuator.back_emf - 0.03).abs() < 1e-15);
        assert!(motor.open.is_empty() && !motor.counts_back_emf_as_friction());
        assert_eq!(partial(Kind::PositionServo, &[]).open, [Open::Gain]);
        assert!(partial(Kind::PositionServo, &[]).counts_back_emf_as_friction());
        assert!(partial(Kind::DcMotor, &[(TorquePerVolt, 0.1), (BackEmf, 0.02)]).open.is_empty());
        assert_eq!(partial(Kind::Pd, &[(Kp, 20.0)]).open, [Open::Kd]);
        assert_eq!(partial(Kind::Torque, &[]).open, []);
    }

    #[test]
    fn an_open_gain_starts_in_the_middle_of_what_is_known() {
        let preset = &super::super::PRESETS[0];
        let start = Open::Gain.start(preset.kind, &preset.constants.iter().copied().collect()).unwrap();
        assert!((start - 0.52 / 5.0).abs() < 1e-12, "{start}");
        assert_eq!(Open::Gain.start(Kind::Current, &Constants::new()), None);
    }

    #[test]
    fn the_loss_follows_the_gain_as_far_as_it_is_known() {
        use Constant::{BackEmf, Resistance, TorqueConstant};
        let by_constant = partial(Kind::DcMotor, &[(TorqueConstant, 0.3)]).with(Open::Gain, 0.1);
        assert!((by_constant.actuator.back_emf - 0.03).abs() < 1e-15);
        let by_resistance = partial(Kind::DcMotor, &[(Resistance, 3.0)]).with(Open::Gain, 0.1);
        assert!((by_resistance.actuator.back_emf - 0.03).abs() < 1e-15);
        let given = partial(Kind::DcMotor, &[(BackEmf, 0.02)]).with(Open::Gain, 0.1);
        assert_eq!(given.actuator.back_emf, 0.02);
    }
}
