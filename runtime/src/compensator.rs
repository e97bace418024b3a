//! What the control loop calls: a measurement in, a torque out, within limits that the firmware sets and no image can change.

use frikan_shared::authentication::Trust;
use frikan_shared::image::ImageError;
use frikan_shared::model::Model;

use crate::evaluate::within;
use crate::friction::{Friction, FrictionState, Measurement, Warmth};
use crate::slots::load;
use crate::table_models::{TableWithPresliding, table_alone};
use crate::usable::above_0_to;

/// Longest sample period that a step takes for real, s.
const LONGEST_SAMPLE: f32 = 1.0;

/// Largest torque limit: the difference of two torques within it is finite.
pub const LARGEST_TORQUE: f32 = 0.25 * f32::MAX;

/// Limits of the firmware, all in force at once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    gain: f32,
    torque: f32,
    slew: f32,
    position: f32,
}

/// Which limit cannot be kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitError {
    /// The gain is negative or not finite.
    Gain,
    /// The largest torque is negative or not finite.
    Torque,
    /// The slew is not positive or not finite: a torque that cannot change would stay for ever.
    Slew,
    /// The largest position is negative or not finite.
    Position,
}

impl Limits {
    /// No compensation at all.
    pub const OFF: Self = Self { gain: 0.0, torque: 0.0, slew: f32::MAX, position: 0.0 };

    /// `gain`: share of the friction that is compensated, 0 to 1 in most drives; `torque`: largest torque put out, in the unit of the
    /// model's output, [`LARGEST_TORQUE`] at most; `slew`: its largest change in a second. A change in one sample below the rounding step of the
    /// torque (6e-8 of it) does not move it. No position is put out until [`Limits::with_position`] allows one.
    ///
    /// # Errors
    /// [`LimitError`] where gain or torque is negative, the slew is not positive, or one of them is not finite.
    pub fn new(gain: f32, torque: f32, slew: f32) -> Result<Self, LimitError> {
        Ok(Self {
            gain: not_negative(gain).ok_or(LimitError::Gain)?,
            torque: within(not_negative(torque).ok_or(LimitError::Torque)?, LARGEST_TORQUE),
            slew: not_negative(slew).filter(|slew| *slew > 0.0).ok_or(LimitError::Slew)?,
            position: 0.0,
        })
    }

    /// With positions of up to `position` rad put out, to either side.
    ///
    /// # Errors
    /// [`LimitError::Position`] where it is negative or not finite.
    pub fn with_position(self, position: f32) -> Result<Self, LimitError> {
        Ok(Self { position: not_negative(position).ok_or(LimitError::Position)?, ..self })
    }

    /// The share of the friction that is compensated.
    #[must_use]
    pub fn gain(&self) -> f32 {
        self.gain
    }

    /// The largest torque put out.
    #[must_use]
    pub fn torque(&self) -> f32 {
        self.torque
    }

    /// Its largest change in a second.
    #[must_use]
    pub fn slew(&self) -> f32 {
        self.slew
    }

    /// The largest position put out, rad.
    #[must_use]
    pub fn position(&self) -> f32 {
        self.position
    }

    /// As near to the torque `wanted` as the torque limit allows and a change of at most `reach` from `torque`, which may lie beyond a limit
    /// that is new. Written as what is taken back of the change wanted, so that rounding does not lead beyond the limit.
    #[inline(always)]
    pub(crate) fn approach(&self, torque: f32, wanted: f32, reach: f32) -> f32 {
        let wanted = within(wanted, self.torque);
        let change = wanted - torque;
        wanted - (change - within(change, reach))
    }
}

/// A limit without the sign of a zero; none where it is negative or not finite.
fn not_negative(limit: f32) -> Option<f32> {
    (limit >= 0.0 && limit.is_finite()).then(|| limit.abs())
}

/// Whether a torque is a compensation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The torque compensates friction.
    Active,
    /// No usable model: the torque is 0.
    NoModel(ImageError),
    /// A channel that the model reads was missing or not finite, or the sample period not above 0 s and at most 1 s: the torque is 0.
    NotFinite,
}

/// The answer to one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Compensation {
    /// Torque to add, in the unit of the model's output.
    pub torque: f32,
    /// What the model says of the link's position against the motor's, rad, within the limit; 0 unless active.
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

    /// Goes on with another model, at the torque put out last, from where the slew limit leads; what the effects of the one before
    /// remember is gone, and so is the warmth, whose meaning belongs to a model.
    pub fn replace_model(&mut self, model: Result<Model<CELLS>, ImageError>) {
        self.running.state = FrictionState::new();
        self.running.torque = if model.is_ok() { self.running.torque } else { 0.0 };
        self.model = model;
    }

    /// The limits in force.
    #[must_use]
    pub fn limits(&self) -> &Limits {
        &self.running.limits
    }

    /// What a step would say of the model: active, or why there is none.
    #[must_use]
    pub fn status(&self) -> Status {
        self.model.as_ref().map_or_else(|error| Status::NoModel(*error), |_| Status::Active)
    }

    /// Changes the limits between two steps; the slew limit holds across the change, that of a lower torque limit too.
    pub fn set_limits(&mut self, limits: Limits) {
        self.running.limits = limits;
    }

    /// Starts from zero torque, at rest and with nothing wound up; the warmth of the joint stays.
    pub fn reset(&mut self) {
        self.restore(&self.warmth(), 0.0);
    }

    /// The warmth of the joint, for the firmware to keep while the power is off.
    #[must_use]
    pub fn warmth(&self) -> Warmth {
        self.model().map_or(Warmth::COLD, |model| self.running.state.warmth(&model.effects))
    }

    /// As [`Compensator::reset`], and as warm as `warmth` is after a rest of so many seconds. Of a rest that nobody measured, 0 s is the
    /// safe guess: warm joints have the lower friction.
    pub fn restore(&mut self, warmth: &Warmth, rest: f32) {
        let effects = self.model.as_ref().map_or(&[][..], |model| &model.effects);
        self.running.state = FrictionState::with_warmth(warmth, effects, rest);
        self.running.torque = 0.0;
    }

    /// The compensation after a sample period of `dt` seconds. Call it at a fixed rate.
    ///
    /// Zero torque at once, and the slew starting from there, when anything that the model reads is missing or not finite or `dt` is not
    /// above 0 s and at most 1 s; what the effects remember is then as before. With a floating-point unit the number of instructions depends on the model alone.
    #[must_use]
    pub fn step(&mut self, measurement: &Measurement, dt: f32) -> Compensation {
        let model = match &self.model {
            Ok(model) => model,
            Err(error) => return Compensation { torque: 0.0, position: 0.0, status: Status::NoModel(*error) },
        };
        let (running, is_step) = (&mut self.running, above_0_to(LONGEST_SAMPLE, dt));
        // The commonest models here, the others in a function of its own: a short way saves no registers of a long one.
        if let Some(friction) = table_alone(model, measurement, is_step) {
            running.put_out(friction, dt)
        } else if let Some(table) = TableWithPresliding::of(model) {
            let friction = table.step(&mut running.state, measurement, dt, is_step);
            running.put_out(friction, dt)
        } else {
            running.step_any(model, measurement, dt, is_step)
        }
    }
}

impl Running {
    /// A step of any model.
    #[inline(never)]
    fn step_any<const CELLS: usize>(
        &mut self,
        model: &Model<CELLS>,
        sample: &Measurement,
        dt: f32,
        is_step: i32,
    ) -> Compensation {
        let mut friction = self.state.step_within(model, sample, dt, is_step);
        friction.position = within(friction.position, self.limits.position);
        self.put_out(friction, dt)
    }

    /// As near to the friction as the limits allow; 0 at once where the sample is of no use.
    #[inline(always)]
    fn put_out(&mut self, friction: Friction, dt: f32) -> Compensation {
        let limits = &self.limits;
        // Nothing here is NaN but where the sample is of no use, and then nothing of it is kept.
        let torque = limits.approach(self.torque, limits.gain * friction.torque, limits.slew * dt);
        self.torque = friction.usable.or_zero(torque);
        let status = if friction.usable.is_usable() { Status::Active } else { Status::NotFinite };
        Compensation { torque: self.torque, position: friction.position, status }
    }
}

#[cfg(test)]
mod faults;
#[cfg(test)]
mod tests;
