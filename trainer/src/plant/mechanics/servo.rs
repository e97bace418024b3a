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
    /// What the joint did over the samples that the controller has yet to see.
    unseen: VecDeque<Motion>,
    /// Samples from a motion to what the controller makes of it, beside that of the drive's loop.
    feedback_delay: usize,
    /// Velocity of the joint at the sample before, rad/s.
    velocity_before: Option<f64>,
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
            unseen: VecDeque::new(),
            feedback_delay: (actuator.feedback_delay_s * joint.drive.rate_hz).round() as usize,
            velocity_before: None,
            sample_s: 1.0 / joint.drive.rate_hz,
            actuator: Actuator { feedback_delay_s: 0.0, ..actuator },
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
            kp: None,
            enabled: true,
        }
    }

    /// Torque over the sample that begins now, N m, at which this is commanded; the drive sees a motion, and the joint moves at a velocity, rad/s, by
    /// which a motor loses torque at once.
    pub(crate) fn drive(&mut self, command: Command, motion: Motion, velocity: f64) -> f64 {
        let reference = self.reference.follow(command.reference, self.sample_s);
        self.under_way.push_back(Command { reference, ..command });
        let arrived = if self.under_way.len() > self.delay { self.under_way.pop_front() } else { None };
        // Before the first command has arrived the actuator holds where it is told to begin.
        let acting = arrived.or_else(|| self.under_way.front().copied()).unwrap_or_default();
        self.unseen.push_back(motion);
        let seen = if self.unseen.len() > self.feedback_delay { self.unseen.pop_front() } else { None };
        let seen = seen.or_else(|| self.unseen.front().copied()).unwrap_or(motion);
        // In the middle of the sample, by the slope over the one before (Adams & Bashforth).
        let before = self.velocity_before.replace(velocity).unwrap_or(velocity);
        let in_the_middle = 1.5 * velocity - 0.5 * before;
        let damped_by = if self.actuator.kind.is_motor() { in_the_middle } else { seen.velocity };
        self.actuator.apply(&acting, Motion { velocity: damped_by, ..seen }).at(damped_by)
    }

    pub(crate) fn actuator(&self) -> &Actuator {
        &self.actuator
    }
}
