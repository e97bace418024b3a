//! Supervision of a compensator: it takes the velocity of the reference and of the joint, lowers the gain where compensation feeds the joint,
//! holds the torque at rest, ramps it down where velocity and position contradict each other, and follows a friction that changes.
//!
//! Around whatever can [`Compensate`], whose step costs what it costs without supervision. Branches depend on the sample here.

use crate::bounds::limited;
use crate::compensator::{Compensate, Status};
use crate::measurement::Measurement;

pub mod adaptation;
pub mod adaptation_settings;
pub mod blend;
pub mod monitor;
pub mod observer;
pub mod pace;
pub mod plausibility;
mod settings;

use adaptation::{Adaptation, Correction, Torques};
use blend::{blended, share_without_reference};
use monitor::Monitor;
use observer::{Observation, Observer};
use pace::Pace;
use plausibility::Plausibility;
use settings::FASTEST;

pub use settings::{DEFAULT_GAIN, Supervision, VelocitySource};

/// One sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The joint, `velocity` as measured; `position` has to be filled, and without jumps.
    pub measurement: Measurement,
    /// Velocity of the reference, rad/s; none while no position or velocity loop is closed, as in hand guiding.
    pub reference_velocity: Option<f32>,
    /// Torque that acted on the joint since the sample before, N m, without compensation and without the torque for gravity.
    pub loop_torque: f32,
}

/// Whether the torque is a compensation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Supervised {
    /// As the compensator says.
    Compensator(Status),
    /// Velocity and position have contradicted each other for too long: the torque ramps down to 0.
    Implausible,
}

/// The answer to a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SupervisedCompensation {
    /// Torque to add, in the unit of the model's output.
    pub torque: f32,
    /// What the model says of the link's position against the motor's, rad.
    pub position: f32,
    /// Share of the firmware's gain that the monitor leaves, 0 to 1.
    pub gain_share: f32,
    /// How the friction differs from the model, as far as it was learnt.
    pub correction: Correction,
    /// Whether it is a compensation.
    pub status: Supervised,
}

/// Supervision of one joint's compensator, which it drives: the compensator has the model, the limits and the warmth, the supervisor what it
/// has observed.
#[derive(Clone, Debug)]
pub struct Supervisor {
    settings: Supervision,
    pace: Pace,
    observer: Observer,
    monitor: Monitor,
    adaptation: Adaptation,
    plausibility: Plausibility,
    /// What was put out last, before the share of the monitor.
    held: f32,
    torque: f32,
}

impl Supervisor {
    /// Nothing observed yet.
    #[must_use]
    pub fn new(settings: Supervision) -> Self {
        Self {
            settings,
            pace: Pace::NONE,
            observer: Observer::default(),
            monitor: Monitor::new(),
            adaptation: Adaptation::new(),
            plausibility: Plausibility::default(),
            held: 0.0,
            torque: 0.0,
        }
    }

    /// How the friction differs from the model, as far as it was learnt; a reset of the compensator does not touch it.
    #[must_use]
    pub fn correction(&self) -> Correction {
        self.adaptation.correction()
    }

    /// Forgets what was learnt, for a joint that was idle for long or has another gear or grease.
    pub fn forget(&mut self) {
        self.adaptation = Adaptation::new();
    }

    /// The compensation by `compensator`, within its limits, after a sample period of `dt` seconds.
    #[must_use]
    pub fn step(&mut self, compensator: &mut impl Compensate, sample: &Sample, dt: f32) -> SupervisedCompensation {
        let Measurement { velocity, position, .. } = sample.measurement;
        let reference = sample.reference_velocity;
        let is_finite = velocity.is_finite()
            && position.is_finite()
            && sample.loop_torque.is_finite()
            && reference.is_none_or(f32::is_finite)
            && dt > 0.0;
        if !is_finite {
            return self.off(Status::NotFinite);
        }
        let limits = *compensator.limits();
        let rest = self.settings.rest_velocity;
        let chosen = match (self.settings.source, reference) {
            (VelocitySource::Measured, _) | (VelocitySource::Blended, None) => velocity,
            (VelocitySource::Reference, reference) => reference.unwrap_or(0.0),
            (VelocitySource::Blended, Some(reference)) => blended(&self.settings, velocity, reference),
        };
        let answer = compensator.step(&Measurement { velocity: chosen, ..sample.measurement }, dt);
        if answer.status != Status::Active {
            return self.off(answer.status);
        }
        // What no joint does must not overflow what the filters remember.
        let (velocity, loop_torque) = (limited(velocity, FASTEST), limited(sample.loop_torque, STRONGEST_LOOP));
        if dt != self.pace.dt {
            self.pace = Pace::at(&self.settings, dt);
        }
        let observed = self.observer.observe(&self.settings, &self.pace, velocity, loop_torque);
        self.monitor.take(&self.settings, &self.pace, &observed, answer.torque);
        let is_plausible = self.plausibility.observe(&self.settings, &self.pace, velocity, position);
        // Without a reference somebody pushes, and what the push does would pass for friction.
        let is_sliding = observed.slides && observed.velocity.abs() > 2.0 * rest;
        let may_learn = is_plausible && is_sliding && reference.is_some();
        let compensated = self.adapted(&observed, (answer.torque, limits.gain()), chosen, may_learn);
        let is_blended = self.settings.source == VelocitySource::Blended;
        let wanted = match reference {
            // At rest the torque stays as it is: to switch it would move the joint.
            Some(reference) if is_blended && reference.abs() < HOLD * rest && velocity.abs() < rest => self.held,
            None if is_blended => share_without_reference(&self.settings, velocity) * compensated,
            _ => compensated,
        };
        self.held = wanted;
        let share = if self.settings.monitored { self.monitor.share() } else { 1.0 };
        let believed = if is_plausible { share * wanted } else { 0.0 };
        let reach = if is_plausible { limits.slew() * dt } else { self.ramp(limits.torque(), dt) };
        self.torque = limits.approach(self.torque, believed, reach);
        let status = if is_plausible { Supervised::Compensator(Status::Active) } else { Supervised::Implausible };
        let correction = self.correction();
        SupervisedCompensation { torque: self.torque, position: answer.position, gain_share: share, correction, status }
    }

    /// The compensation at a velocity, where the model's is `torque` at a gain, with what the adaptation has learnt.
    fn adapted(&mut self, observed: &Observation, (torque, gain): (f32, f32), velocity: f32, may_learn: bool) -> f32 {
        let Some(settings) = self.settings.adaptation.as_ref().filter(|_| gain >= LEAST_GAIN) else { return torque };
        let torques = Torques { friction: torque / gain, compensation: self.torque };
        self.adaptation.take(settings, observed, torques, &self.pace, may_learn);
        gain * self.adaptation.correction().applied(torques.friction, velocity)
    }

    /// Largest change of an implausible torque in `dt`: all of its limit in the time in which the contradiction was found.
    fn ramp(&self, limit: f32, dt: f32) -> f32 {
        limit * dt / self.settings.implausible_time
    }

    /// No torque, at once.
    fn off(&mut self, status: Status) -> SupervisedCompensation {
        (self.torque, self.held) = (0.0, 0.0);
        let (gain_share, correction) = (self.monitor.share(), self.correction());
        let status = Supervised::Compensator(status);
        SupervisedCompensation { torque: 0.0, position: 0.0, gain_share, correction, status }
    }
}

/// Gain below which the friction of the model cannot be told from its compensation.
const LEAST_GAIN: f32 = 0.05;

/// Torque beyond any drive's, N m.
const STRONGEST_LOOP: f32 = 1.0e9;

/// Share of the rest velocity below which a reference stands still.
const HOLD: f32 = 0.05;

#[cfg(all(test, feature = "models"))]
mod tests;
