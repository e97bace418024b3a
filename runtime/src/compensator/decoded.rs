//! Compensation by an image that is decoded to a model in memory.

use frikan_shared::authentication::Trust;
use frikan_shared::authentication::admission::Admission;
use frikan_shared::image::{ImageError, model_checksum};
use frikan_shared::model::Model;

use super::limited::{FrictionModel, Limited};
use super::limits::Limits;
use crate::bounds::within;
use crate::friction::{FrictionState, Warmth};
use crate::laws::evaluate::is_built_in;
use crate::measurement::{Friction, Measurement};
use crate::table_models::{TableWithPresliding, table_alone};

/// A model in memory and what its effects remember.
#[derive(Clone, Debug)]
pub struct Decoded<const CELLS: usize> {
    model: Model<CELLS>,
    state: FrictionState,
}

/// Friction compensation of one joint, with room for `CELLS` cells.
pub type Compensator<const CELLS: usize> = Limited<Decoded<CELLS>>;

impl<const CELLS: usize> Decoded<CELLS> {
    /// A model at rest and cold.
    ///
    /// # Errors
    /// [`ImageError::NotBuiltIn`] where the firmware was built without what the model is made of.
    pub fn new(model: Model<CELLS>) -> Result<Self, ImageError> {
        if is_built_in(&model) { Ok(Self { model, state: FrictionState::new() }) } else { Err(ImageError::NotBuiltIn) }
    }

    /// How warm the joint is.
    #[must_use]
    pub fn warmth(&self) -> Warmth {
        self.state.warmth(&self.model.effects)
    }

    /// At rest, and as warm as `warmth` is after a rest of so many seconds.
    pub fn restore(&mut self, warmth: &Warmth, rest: f32) {
        self.state = FrictionState::with_warmth(warmth, &self.model.effects, rest);
    }

    /// The friction of a model that is none of the commonest.
    #[inline(never)]
    fn friction_of_any(&mut self, measurement: &Measurement, dt: f32, is_step: i32, largest_position: f32) -> Friction {
        let friction = self.state.step_within(&self.model, measurement, dt, is_step);
        Friction { position: within(friction.position, largest_position), ..friction }
    }
}

impl<const CELLS: usize> FrictionModel for Decoded<CELLS> {
    #[inline(always)]
    fn friction(&mut self, measurement: &Measurement, dt: f32, is_step: i32, largest_position: f32) -> Friction {
        // The commonest models here, the others in a function of its own: a short way saves no registers of a long one.
        if let Some(friction) = table_alone(&self.model, measurement, is_step) {
            friction
        } else if let Some(table) = TableWithPresliding::of(&self.model) {
            table.step(&mut self.state, measurement, dt, is_step)
        } else {
            self.friction_of_any(measurement, dt, is_step, largest_position)
        }
    }

    fn rest(&mut self) {
        self.restore(&self.warmth(), 0.0);
    }

    fn checksum(&self) -> Option<u32> {
        Some(model_checksum(&self.model))
    }
}

impl<const CELLS: usize> Compensator<CELLS> {
    /// Compensation by the model of an image. An image that is refused switches compensation off, and every step says why.
    #[must_use]
    pub fn new(image: &[u8], limits: Limits) -> Self {
        Self::trusting(image, Trust::Anyone, limits)
    }

    /// Compensation by an image that is admitted.
    #[must_use]
    pub fn admitting(image: &[u8], admission: &Admission<'_>, limits: Limits) -> Self {
        Self::with_model(admission.decode(image).map(|image| image.model), limits)
    }

    /// Compensation by an image of whom `trust` names.
    #[must_use]
    pub fn trusting(image: &[u8], trust: Trust<'_>, limits: Limits) -> Self {
        Self::with_model(trust.decode(image).map(|image| image.model), limits)
    }

    /// Compensation by the newest usable image of two slots of flash.
    #[cfg(feature = "slots")]
    #[must_use]
    pub fn from_slots(first: &[u8], second: &[u8], trust: Trust<'_>, limits: Limits) -> Self {
        Self::with_model(crate::slots::load(first, second, trust).map(|(_, image)| image.model), limits)
    }

    /// Compensation by a decoded model, or off for the reason given.
    #[must_use]
    pub fn with_model(model: Result<Model<CELLS>, ImageError>, limits: Limits) -> Self {
        Self::by(model.and_then(Decoded::new), limits)
    }

    /// The model, where there is one.
    #[must_use]
    pub fn model(&self) -> Option<&Model<CELLS>> {
        self.source().map(|decoded| &decoded.model)
    }

    /// Goes on with another model, at the torque put out last, from where the slew limit leads; what the effects of the one before
    /// remember is gone, and so is the warmth, whose meaning belongs to a model.
    pub fn replace_model(&mut self, model: Result<Model<CELLS>, ImageError>) {
        self.replace(model.and_then(Decoded::new));
    }

    /// The warmth of the joint, for the firmware to keep while the power is off.
    #[must_use]
    pub fn warmth(&self) -> Warmth {
        self.source().map_or(Warmth::COLD, Decoded::warmth)
    }

    /// As [`Limited::reset`], and as warm as `warmth` is after a rest of so many seconds. Of a rest that nobody measured, 0 s is the
    /// safe guess: warm joints have the lower friction.
    pub fn restore(&mut self, warmth: &Warmth, rest: f32) {
        self.reset_by(|decoded| decoded.restore(warmth, rest));
    }
}
