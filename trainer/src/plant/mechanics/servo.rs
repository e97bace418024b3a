//! A drive without torque sensor: its actuator makes a torque of a reference, a current or a duty, and it writes down these alone.

use crate::actuator::{Actuator, Command, FeedForward, Motion, RateLimited};
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

    /// The command of a reference, rad and rad/s, to an actuator that is switched on, with the current, A, duty or voltage, V, by which a
    /// controller of its own gets the torque `wanted`, N m, at a velocity, rad/s.
    pub(crate) fn command(&self, reference: Motion, wanted: f64, form: FeedForward, velocity: f64) -> Command {
        Command {
            effort: self.actuator.effort_for(form, wanted, velocity),
            is_voltage: form == FeedForward::Voltage,
            reference: reference.position,
            reference_velocity: reference.velocity,
            feed_forward: 0.0,
            supply: self.actuator.supply,
            kp: self.actuator.kp,
            enabled: true,
        }
    }

    /// Torque over the sample that begins now, N m, at which this is commanded.
    pub(crate) fn drive(&mut self, command: Command, motion: Motion) -> f64 {
        let reference = self.reference.follow(command.reference, self.sample_s);
        self.under_way.push_back(Command { reference, ..command });
        let arrived = if self.under_way.len() > self.delay { self.under_way.pop_front() } else { None };
        // Before the first command has arrived the actuator holds where it is told to begin.
        let acting = arrived.or_else(|| self.under_way.front().copied()).unwrap_or_default();
        self.actuator.apply(&acting, motion).at(motion.velocity)
    }

    pub(crate) fn actuator(&self) -> &Actuator {
        &self.actuator
    }
}
