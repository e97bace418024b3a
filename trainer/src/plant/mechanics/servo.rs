//! A drive without torque sensor: its actuator makes a torque of a reference, a current or a duty, and it writes down these alone.

use crate::actuator::{Actuator, Command, Kind, Motion, RateLimited};
use crate::plant::joint::Joint;
use std::collections::VecDeque;

/// An actuator with the commands that are on their way to it.
pub(crate) struct Servo {
    actuator: Actuator,
    reference: RateLimited,
    under_way: VecDeque<Command>,
    /// Samples between a command and its effect.
    delay: usize,
    sample_s: f64,
}

impl Servo {
    /// The actuator of a joint that reports no torque.
    pub(crate) fn of(joint: &Joint) -> Option<Self> {
        let actuator = joint.actuator?;
        Some(Self {
            reference: RateLimited::new(actuator.velocity_limit),
            under_way: VecDeque::new(),
            delay: (actuator.delay_s * joint.drive.rate_hz).round() as usize,
            sample_s: 1.0 / joint.drive.rate_hz,
            actuator,
        })
    }

    /// Torque over the sample that begins now, N m, under a reference, rad and rad/s, and what is written down as commanded: current in A or duty
    /// where these are, for which a controller of its own asks for the torque `wanted`.
    pub(crate) fn drive(&mut self, reference: Motion, wanted: f64, motion: Motion) -> (f64, f64) {
        let actuator = &self.actuator;
        let effort = match actuator.kind {
            Kind::Current => wanted / actuator.gain,
            Kind::DcMotor => {
                let duty = (wanted + actuator.back_emf * motion.velocity) / (actuator.gain * actuator.supply);
                duty.clamp(-actuator.limits.duty, actuator.limits.duty)
            }
            Kind::Torque | Kind::Pd | Kind::PositionServo => wanted,
        };
        self.under_way.push_back(Command {
            effort,
            is_voltage: false,
            reference: self.reference.follow(reference.position, self.sample_s),
            reference_velocity: reference.velocity,
            feed_forward: 0.0,
            supply: actuator.supply,
            kp: actuator.kp,
            enabled: true,
        });
        let arrived = if self.under_way.len() > self.delay { self.under_way.pop_front() } else { None };
        // Before the first command has arrived the actuator holds where it is told to begin.
        let acting = arrived.or_else(|| self.under_way.front().copied()).unwrap_or_default();
        (actuator.apply(&acting, motion).at(motion.velocity), effort)
    }
}
