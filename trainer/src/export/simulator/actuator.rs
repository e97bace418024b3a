//! The actuator of a joint as simulators have one: a stiffness, a damping and a limit, or a gain alone.

use crate::actuator::{Actuator, Kind, Partial};
use crate::error::{Error, Result, codes};
use crate::figures::digits;
use crate::joint::Joint;

/// What a simulator's actuator makes of its control, N m (N) and rad (m).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Law {
    /// A position: `kp (control - q) - kv v`.
    Position { kp: f64, kv: f64 },
    /// A current or voltage: `gain control - kv v`.
    Effort { gain: f64, kv: f64 },
}

/// The actuator of a joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimulatedActuator {
    pub(super) law: Law,
    /// Largest torque, N m (N).
    pub(super) limit: Option<f64>,
    pub(super) delay_s: f64,
    actuator: Actuator,
}

impl SimulatedActuator {
    /// What `[actuator]` of a joint makes in a simulator; `None` of one that puts out the torque that it is told.
    ///
    /// # Errors
    /// `FRK-D014` for a constant that is neither given nor identified.
    pub fn of(joint: &Joint) -> Result<Option<Self>> {
        let partial = Partial::of(joint.actuator.kind, &joint.actuator.constants);
        let actuator = partial.actuator;
        if let Some(lacking) = partial.lacking(actuator.kind == Kind::PositionServo) {
            let message = "a simulator needs this constant of the actuator; `trainer fit` identifies it and writes it beside its image";
            return Err(Error::new(&codes::MISSING_PARAMETER, message).in_column(format!("actuator.{}", lacking.key())));
        }
        let limit_of_torque = Some(actuator.limits.torque).filter(|limit| limit.is_finite());
        let stall = actuator.gain * actuator.supply * actuator.limits.duty;
        let (law, limit) = match actuator.kind {
            Kind::Torque => return Ok(None),
            Kind::Pd => (Law::Position { kp: actuator.kp, kv: actuator.kd }, limit_of_torque),
            Kind::Current => (Law::Effort { gain: actuator.gain, kv: 0.0 }, limit_of_torque),
            Kind::DcMotor => (Law::Effort { gain: actuator.gain, kv: actuator.back_emf }, None),
            Kind::PositionServo => {
                let kp = actuator.gain * actuator.supply * actuator.error_gain * actuator.kp;
                (Law::Position { kp, kv: actuator.back_emf }, Some(stall))
            }
        };
        Ok(Some(Self { law, limit, delay_s: actuator.delay_s, actuator }))
    }

    /// The motor, where it is one whose supply and loss by velocity are known.
    pub(super) fn motor(&self) -> Option<Actuator> {
        Some(self.actuator).filter(|actuator| actuator.kind.is_motor() && actuator.back_emf > 0.0)
    }

    /// Stiffness and damping where it holds a position.
    pub(super) fn gains(&self) -> Option<[f64; 2]> {
        match self.law {
            Law::Position { kp, kv } => Some([kp, kv]),
            Law::Effort { .. } => None,
        }
    }

    /// What it is and what of it a simulator has not, in sentences. `delays` says whether the simulator has delays.
    pub(super) fn told(&self, delays: bool) -> String {
        let mut text = match self.law {
            Law::Position { kp, kv } => format!(" Actuator: kp {} N m/rad, kv {} N m s/rad", digits(kp), digits(kv)),
            Law::Effort { gain, kv } => {
                let unit = if self.actuator.kind == Kind::Current { "A" } else { "V" };
                format!(" Actuator: {} N m/{unit}, loses {} N m s/rad", digits(gain), digits(kv))
            }
        };
        text += &self.limit.map_or_else(|| ".".to_owned(), |limit| format!(", at most {} N m.", digits(limit)));
        let mut left_out = Vec::new();
        if self.delay_s > 0.0 && !delays {
            left_out.push(format!("its delay of {} ms", digits(1e3 * self.delay_s)));
        }
        if self.actuator.feedback_delay_s > 0.0 {
            let late = digits(1e3 * self.actuator.feedback_delay_s);
            left_out.push(format!("that its controller sees the motion {late} ms late"));
        }
        if self.actuator.dead_band > 0.0 {
            left_out.push(format!("its dead band of {} rad", digits(self.actuator.dead_band)));
        }
        if self.actuator.sag > 0.0 {
            left_out.push("the supply that sags with the load".to_owned());
        }
        if self.actuator.velocity_limit.is_finite() {
            left_out.push(format!("the limit of its reference of {} rad/s", digits(self.actuator.velocity_limit)));
        }
        if self.actuator.kind == Kind::PositionServo {
            left_out.push("that its limit is one of the duty, before the loss by the velocity".to_owned());
        }
        if self.actuator.kind == Kind::Pd && self.actuator.kd > 0.0 {
            left_out.push("a commanded velocity, which acts as a position kd/kp further".to_owned());
        }
        if !left_out.is_empty() {
            text += &format!(" Left out of it: {}.", left_out.join(", "));
        }
        text
    }
}
