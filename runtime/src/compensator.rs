//! What the control loop calls: a measurement in, a torque out, within limits that the firmware sets and no image can change.

use frikan_shared::authentication::Trust;
use frikan_shared::image::ImageError;
use frikan_shared::model::Model;

use crate::evaluate::limited;
use crate::friction::{FrictionState, Measurement};
use crate::slots::load;

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
        let sane = |limit: f32| if limit >= 0.0 && limit.is_finite() { limit } else { 0.0 };
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
    state: FrictionState,
    limits: Limits,
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
        let state = FrictionState::new(model.as_ref().map_or(&[][..], |model| model.effects.as_slice()));
        Self { model, state, limits, torque: 0.0 }
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
        self.limits = limits;
    }

    /// Forgets what the effects remember and starts from zero torque.
    pub fn reset(&mut self) {
        self.state = FrictionState::new(self.model.as_ref().map_or(&[][..], |model| model.effects.as_slice()));
        self.torque = 0.0;
    }

    /// The compensation after a sample period of `dt` seconds. Call it at a fixed rate.
    ///
    /// Zero torque at once, and the slew starting from there, when anything that the model reads is not finite.
    #[must_use]
    pub fn step(&mut self, measurement: &Measurement, dt: f32) -> Compensation {
        let model = match &self.model {
            Ok(model) => model,
            Err(error) => return Compensation { torque: 0.0, position: 0.0, status: Status::NoModel(*error) },
        };
        let channels = measurement.channels(&model.inputs);
        if !(0.0..=LONGEST_SAMPLE).contains(&dt) || channels.iter().any(|channel| !channel.is_finite()) {
            self.torque = 0.0;
            return Compensation { torque: 0.0, position: 0.0, status: Status::NotFinite };
        }
        let friction = self.state.step(model, measurement, dt);
        let wanted = limited(self.limits.gain * friction.torque, self.limits.torque);
        let change = limited(wanted - self.torque, self.limits.slew * dt);
        self.torque = limited(self.torque + change, self.limits.torque);
        Compensation { torque: self.torque, position: friction.position, status: Status::Active }
    }
}

#[cfg(test)]
mod tests;
