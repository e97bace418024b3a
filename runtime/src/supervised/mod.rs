//! Supervision of a compensator: it takes the velocity of the reference and of the joint, lowers the gain where compensation feeds the joint,
//! holds the torque at rest, ramps it down where velocity and position contradict each other, and follows a friction that changes.
//!
//! Around whatever can [`Compensate`], whose step costs what it costs without supervision. Branches depend on the sample here.

use crate::bounds::limited;
use crate::compensator::{Compensate, Limits, Status};
use crate::measurement::Measurement;
use crate::usable::{above_0_to, finite};

pub mod adaptation;
pub mod adaptation_settings;
pub mod blend;
pub mod monitor;
pub mod observer;
pub mod pace;
pub mod plausibility;
pub mod rest;
mod settings;
pub mod velocity;

use adaptation::{Adaptation, Correction, Learnt, Torques};
use blend::{blended, share_without_reference};
use monitor::Monitor;
use observer::{Observation, Observer};
use pace::Pace;
use plausibility::Plausibility;
use rest::Rest;
use settings::{FASTEST, is_within};
use velocity::Velocity;

pub use settings::{DEFAULT_GAIN, Supervision, SupervisionError, VelocitySource};

/// One sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The joint, `velocity` as measured; `position` has to be filled, and without jumps but that of a turn.
    pub measurement: Measurement,
    /// Velocity of the reference, rad/s; none while no position or velocity loop is closed, as in hand guiding.
    pub reference_velocity: Option<f32>,
    /// Torque that acted on the joint since the sample before, N m, without compensation and without the torque for gravity.
    pub loop_torque: f32,
}

/// Whether the torque is a compensation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Supervised {
    /// As the compensator says. Where it gives none, the torque falls to 0 within its slew limit.
    Compensator(Status),
    /// Compensated, but by less than half of what the gain asks for, since more would feed the joint; or slowly, with an encoder that has too few
    /// counts to tell whether the joint sticks.
    Degraded,
    /// Velocity and position have contradicted each other for too long: the torque ramps down to 0 and stays there until
    /// [`Supervisor::clear_fault`].
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
    is_implausible: bool,
    velocity: Velocity,
    /// Position of the last sample that was one, rad, and how long before the one before this it was, s.
    position: Option<(f32, f32)>,
    /// Inertia in force, kg m^2.
    inertia: f32,
    rest: Rest,
    torque: f32,
    /// Which of the compensator's models the adaptation learns on; none before the first sample.
    changes: Option<u32>,
}

impl Supervisor {
    /// Nothing observed yet.
    ///
    /// # Errors
    /// [`SupervisionError`] where a setting is out of range.
    pub fn new(settings: Supervision) -> Result<Self, SupervisionError> {
        settings.validate()?;
        Ok(Self {
            pace: Pace::of(&settings),
            settings,
            observer: Observer::default(),
            monitor: Monitor::new(),
            adaptation: Adaptation::new(),
            plausibility: Plausibility::default(),
            is_implausible: false,
            velocity: Velocity::default(),
            position: None,
            inertia: settings.inertia,
            rest: Rest::default(),
            torque: 0.0,
            changes: None,
        })
    }

    /// How the friction differs from the model, as far as it was learnt; a reset of the compensator does not touch it.
    #[must_use]
    pub fn correction(&self) -> Correction {
        self.adaptation.correction()
    }

    /// Another inertia of the joint from now on, kg m^2: of the pose or the payload, in each sample if need be. The torque of an inertia that changes,
    /// `dJ/dt v / 2`, belongs to the loop torque.
    ///
    /// # Errors
    /// [`SupervisionError::Inertia`] where it is not from 0 to 1e9: the one before stays in force.
    pub fn set_inertia(&mut self, inertia: f32) -> Result<(), SupervisionError> {
        if !is_within(0.0, inertia) {
            return Err(SupervisionError::Inertia);
        }
        self.inertia = inertia;
        Ok(())
    }

    /// Forgets what was learnt, for a joint that was idle for long or has another gear or grease. What was learnt on one model is forgotten
    /// with the next anyway.
    pub fn forget(&mut self) {
        self.adaptation = Adaptation::new();
    }

    /// What was learnt, for the firmware to keep while the power is off.
    #[must_use]
    pub fn learnt(&self) -> Learnt {
        self.adaptation.learnt()
    }

    /// Goes on with what was learnt on the model of the compensator before the power was off; without an adaptation, with nothing.
    pub fn restore(&mut self, learnt: &Learnt) {
        let settings = self.settings.adaptation.as_ref();
        self.adaptation = settings.map_or(Adaptation::new(), |settings| Adaptation::again(learnt, settings));
    }

    /// Compensates again after [`Supervised::Implausible`]: for whoever has found out why velocity and position contradicted each other.
    pub fn clear_fault(&mut self) {
        (self.plausibility, self.is_implausible) = (Plausibility::default(), false);
    }

    /// The compensation by `compensator`, within its limits, after a sample period of `dt` seconds.
    #[must_use]
    pub fn step(&mut self, compensator: &mut impl Compensate, sample: &Sample, dt: f32) -> SupervisedCompensation {
        let changes = compensator.changes();
        if self.changes.replace(changes).is_some_and(|before| before != changes) {
            self.forget();
        }
        let limits = *compensator.limits();
        let Measurement { velocity, position, .. } = sample.measurement;
        let reference = sample.reference_velocity;
        let is_usable = finite(velocity)
            & finite(position)
            & finite(sample.loop_torque)
            & finite(reference.unwrap_or(0.0))
            & above_0_to(f32::MAX, dt);
        if is_usable >= 0 {
            return self.off(Status::NotFinite, &limits, dt);
        }
        if dt != self.pace.dt {
            self.pace.set(&self.settings, dt);
        }
        // What no joint does must not overflow what the filters remember.
        let (velocity, loop_torque) = (limited(velocity, FASTEST), limited(sample.loop_torque, STRONGEST_LOOP));
        let reference = reference.map(|reference| limited(reference, FASTEST));
        let rest = self.settings.rest_velocity;
        let believed = self.velocity.take(&self.pace, velocity, reference);
        let chosen = match (self.settings.source, reference) {
            (VelocitySource::Measured, _) => velocity,
            (VelocitySource::Blended, None) => believed,
            (VelocitySource::Reference, reference) => reference.unwrap_or(0.0),
            (VelocitySource::Blended, Some(reference)) => blended(&self.settings, believed, reference),
        };
        let answer = compensator.step(&Measurement { velocity: chosen, ..sample.measurement }, dt);
        if answer.status != Status::Active {
            return self.off(answer.status, &limits, dt);
        }
        let of_position = limited(self.velocity_of(position), FASTEST);
        self.position = Some((position, 0.0));
        let observed = self.observer.observe(&self.settings, &self.pace, of_position, (loop_torque, self.inertia));
        self.monitor.take(&self.settings, &self.pace, &observed, answer.torque);
        self.is_implausible |= !self.plausibility.observe(&self.settings, &self.pace, velocity, of_position);
        let is_plausible = !self.is_implausible;
        let is_sliding = observed.slides && observed.velocity.abs() > 2.0 * rest;
        // Without a reference somebody pushes, and what the push does would pass for friction; where it stands, the observer still remembers
        // the motion.
        let may_learn = is_plausible && is_sliding && reference.is_some_and(|reference| reference.abs() > 2.0 * rest);
        let compensated = self.adapted(&observed, (answer.torque, limits.gain()), chosen, may_learn);
        let is_blended = self.settings.source == VelocitySource::Blended;
        let wanted = match reference {
            Some(reference) if is_blended && reference.abs() < HOLD * rest && believed.abs() < rest => {
                self.rest.standing(&self.pace)
            }
            None if is_blended => self.rest.moving(share_without_reference(&self.settings, believed) * compensated),
            _ => self.rest.moving(compensated),
        };
        let share = if self.settings.monitored { self.monitor.share() } else { 1.0 };
        let allowed = if is_plausible { share * wanted } else { 0.0 };
        let reach = if is_plausible { limits.slew() * dt } else { self.ramp(limits.torque(), dt) };
        self.torque = limits.approach(self.torque, allowed, reach);
        let is_unseen = self.pace.is_coarse && observed.velocity.abs() < rest;
        let status = match (is_plausible, share < LEAST_SHARE || is_unseen) {
            (false, _) => Supervised::Implausible,
            (true, true) => Supervised::Degraded,
            (true, false) => Supervised::Compensator(Status::Active),
        };
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

    /// Velocity on the way to a position since the last one, rad/s.
    fn velocity_of(&self, position: f32) -> f32 {
        let Some((before, missed)) = self.position else { return 0.0 };
        let (way, turn) = (position - before, self.settings.turn);
        // The shorter way round; of a turn of 0 there is no other.
        let way = if way.abs() > 0.5 * turn { way - turn.copysign(way) } else { way };
        if missed == 0.0 { way * self.pace.rate } else { way / (self.pace.dt + missed) }
    }

    /// Largest change of an implausible torque in `dt`: all of its limit in the time in which the contradiction was found.
    fn ramp(&self, limit: f32, dt: f32) -> f32 {
        limit * dt / self.settings.implausible_time
    }

    /// No torque, as soon as the slew limit allows; what was held stays so, for the sample after one that is missing.
    fn off(&mut self, status: Status, limits: &Limits, dt: f32) -> SupervisedCompensation {
        let dt = if dt > 0.0 { dt } else { self.pace.dt };
        self.torque = limits.approach(self.torque, 0.0, limits.slew() * dt);
        self.position = self.position.map(|(position, missed)| (position, missed + dt));
        let (gain_share, correction) = (self.monitor.share(), self.correction());
        let status = Supervised::Compensator(status);
        SupervisedCompensation { torque: self.torque, position: 0.0, gain_share, correction, status }
    }
}

/// Share of the gain below which a compensation is degraded.
const LEAST_SHARE: f32 = 0.5;

/// Gain below which the friction of the model cannot be told from its compensation.
const LEAST_GAIN: f32 = 0.05;

/// Torque beyond any drive's, N m.
const STRONGEST_LOOP: f32 = 1.0e9;

/// Share of the rest velocity below which a reference stands still.
const HOLD: f32 = 0.05;

#[cfg(all(test, feature = "models"))]
mod tests;
