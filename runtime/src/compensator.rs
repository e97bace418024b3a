//! What the control loop calls: a measurement in, a torque out, within limits that the firmware sets and no image can change.

use frikan_shared::authentication::Trust;
use frikan_shared::image::ImageError;
use frikan_shared::model::Model;

use crate::evaluate::within;
use crate::friction::{Friction, FrictionState, Measurement};
use crate::slots::load;
use crate::table_models::{TableWithPresliding, table_alone};
use crate::usable::from_0_to;

/// Longest sample period that a step takes for real, s.
const LONGEST_SAMPLE: f32 = 1.0;

/// Limits of the firmware.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    gain: f32,
    torque: f32,
    slew: f32,
}

impl Limits {
    /// `gain`: share of the friction that is compensated, 0 to 1 in most drives; `torque`: largest torque put out, in the unit of the
    /// model's output; `slew`: its largest change in a second. What is negative or not finite counts as 0, that is, off.
    #[must_use]
    pub fn new(gain: f32, torque: f32, slew: f32) -> Self {
        let sane = |limit: f32| if limit > 0.0 && limit.is_finite() { limit } else { 0.0 };
        Self { gain: sane(gain), torque: sane(torque), slew: sane(slew) }
    }
}

/// Whether a torque is a compensation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The torque compensates friction.
    Active,
    /// No usable model: the torque is 0.
    NoModel(ImageError),
    /// A channel that the model reads, or the sample period, was not finite: the torque is 0.
    NotFinite,
}

/// The answer to one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensation {
    /// Torque to add, in the unit of the model's output.
    pub torque: f32,
    /// What the model says of the link's position against the motor's, rad; 0 unless active.
    pub position: f32,
    /// Whether it is a compensation.
    pub status: Status,
}

/// Friction compensation of one joint, with room for `CELLS` cells.
#[derive(Clone, Debug)]
pub struct Compensator<const CELLS: usize> {
    model: Result<Model<CELLS>, ImageError>,
    running: Running,
}

/// What goes on from one step to the next.
#[derive(Clone, Debug)]
struct Running {
    state: FrictionState,
    limits: Limits,
    /// What was put out last.
    torque: f32,
}

impl<const CELLS: usize> Compensator<CELLS> {
    /// Compensation by the model of an image. An image that is refused switches compensation off, and every step says why.
    #[must_use]
    pub fn new(image: &[u8], limits: Limits) -> Self {
        Self::trusting(image, Trust::Anyone, limits)
    }

    /// Compensation by an image of whom `trust` names.
    #[must_use]
    pub fn trusting(image: &[u8], trust: Trust<'_>, limits: Limits) -> Self {
        Self::with_model(trust.decode(image).map(|image| image.model), limits)
    }

    /// Compensation by the newest usable image of two slots of flash.
    #[must_use]
    pub fn from_slots(first: &[u8], second: &[u8], trust: Trust<'_>, limits: Limits) -> Self {
        Self::with_model(load(first, second, trust).map(|(_, image)| image.model), limits)
    }

    /// Compensation by a decoded model, or off for the reason given.
    #[must_use]
    pub fn with_model(model: Result<Model<CELLS>, ImageError>, limits: Limits) -> Self {
        Self { model, running: Running { state: FrictionState::new(), limits, torque: 0.0 } }
    }

    /// The model, where there is one.
    #[must_use]
    pub fn model(&self) -> Option<&Model<CELLS>> {
        self.model.as_ref().ok()
    }

    /// What a step would say of the model: active, or why there is none.
    #[must_use]
    pub fn status(&self) -> Status {
        self.model.as_ref().map_or_else(|error| Status::NoModel(*error), |_| Status::Active)
    }

    /// Changes the limits between two steps; the slew limit holds across the change.
    pub fn set_limits(&mut self, limits: Limits) {
        self.running.limits = limits;
    }

    /// Forgets what the effects remember and starts from zero torque.
    pub fn reset(&mut self) {
        self.running.state = FrictionState::new();
        self.running.torque = 0.0;
    }

    /// The compensation after a sample period of `dt` seconds. Call it at a fixed rate.
    ///
    /// Zero torque at once, and the slew starting from there, when anything that the model reads is not finite or `dt` is not from 0 to 1 s;
    /// what the effects remember is then as before. With a floating-point unit the number of instructions depends on the model alone.
    #[must_use]
    pub fn step(&mut self, measurement: &Measurement, dt: f32) -> Compensation {
        let model = match &self.model {
            Ok(model) => model,
            Err(error) => return Compensation { torque: 0.0, position: 0.0, status: Status::NoModel(*error) },
        };
        let (running, is_step) = (&mut self.running, from_0_to(LONGEST_SAMPLE, dt));
        // The commonest models here, the others in a function of its own: a short way saves no registers of a long one.
        if let Some(friction) = table_alone(model, measurement, is_step) {
            running.put_out(friction, dt)
        } else if let Some(table) = TableWithPresliding::of(model) {
            let friction = table.step(&mut running.state, measurement, dt, is_step);
            running.put_out(friction, dt)
        } else {
            running.step_any(model, measurement, dt)
        }
    }
}

impl Running {
    /// A step of any model.
    #[inline(never)]
    fn step_any<const CELLS: usize>(&mut self, model: &Model<CELLS>, sample: &Measurement, dt: f32) -> Compensation {
        let friction = self.state.step_within(model, sample, dt, LONGEST_SAMPLE);
        self.put_out(friction, dt)
    }

    /// As near to the friction as the limits allow; 0 at once where the sample is of no use.
    #[inline(always)]
    fn put_out(&mut self, friction: Friction, dt: f32) -> Compensation {
        let limits = &self.limits;
        // Nothing here is NaN but where the sample is of no use, and then nothing of it is kept.
        let change = within(limits.gain * friction.torque - self.torque, limits.slew * dt);
        self.torque = friction.usable.or_zero(within(self.torque + change, limits.torque));
        let status = if friction.usable.is_usable() { Status::Active } else { Status::NotFinite };
        Compensation { torque: self.torque, position: friction.position, status }
    }
}

#[cfg(test)]
mod tests;
