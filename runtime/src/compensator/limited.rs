//! A model within limits.

use frikan_shared::image::ImageError;

use super::limits::{Compensation, Limits, Output, Status};
use crate::measurement::{Friction, Measurement};
use crate::usable::above_0_to_1;

/// What gives the friction of a joint, one sample after the other: a model that was decoded, a table in flash, a law that was exported.
pub trait FrictionModel {
    /// Friction after a sample period of `dt` seconds, its position within `largest_position`.
    ///
    /// `is_step` is negative where `dt` is a sample period. Where it is not, and where a channel that the model reads is not finite, the
    /// friction is not [usable](Friction::usable), and nothing of the sample may be remembered. What is usable is finite.
    fn friction(&mut self, measurement: &Measurement, dt: f32, is_step: i32, largest_position: f32) -> Friction;

    /// [`FrictionModel::friction`] with `gain` times its torque: the same bits, where a model comes by them with fewer instructions.
    #[inline(always)]
    fn share(
        &mut self,
        gain: f32,
        measurement: &Measurement,
        dt: f32,
        is_step: i32,
        largest_position: f32,
    ) -> Friction {
        let friction = self.friction(measurement, dt, is_step, largest_position);
        Friction { torque: gain * friction.torque, ..friction }
    }

    /// The joint rests, and nothing is wound up.
    fn rest(&mut self);

    /// CRC-32 of what is evaluated, as it is now in memory or flash; none where that is code.
    fn checksum(&self) -> Option<u32> {
        None
    }
}

/// What compensates the friction of a joint within limits, to be supervised.
pub trait Compensate {
    /// The limits in force.
    fn limits(&self) -> &Limits;

    /// How often the model was changed: what was learnt on one says nothing of the next.
    fn changes(&self) -> u32;

    /// The compensation after a sample period of `dt` seconds.
    fn step(&mut self, measurement: &Measurement, dt: f32) -> Compensation;
}

/// Friction compensation of one joint by a model `M`, within limits.
#[derive(Clone, Debug)]
pub struct Limited<M> {
    pub(super) model: Result<M, ImageError>,
    pub(super) output: Output,
    changes: u32,
}

impl<M: FrictionModel> Limited<M> {
    /// Compensation by a model, or off for the reason given.
    #[must_use]
    pub fn by(model: Result<M, ImageError>, limits: Limits) -> Self {
        Self { model, output: Output::new(limits), changes: 0 }
    }

    /// Goes on with another model, at the torque put out last, from where the slew limit leads.
    pub fn replace(&mut self, model: Result<M, ImageError>) {
        if model.is_err() {
            self.output.release();
        }
        self.model = model;
        self.changes = self.changes.wrapping_add(1);
    }

    /// The limits in force.
    #[must_use]
    pub fn limits(&self) -> &Limits {
        self.output.limits()
    }

    /// Changes the limits between two steps; the slew limit holds across the change, that of a lower torque limit too.
    pub fn set_limits(&mut self, limits: Limits) {
        self.output.set_limits(limits);
    }

    /// What a step would say of the model: active, or why there is none.
    #[must_use]
    pub fn status(&self) -> Status {
        self.model.as_ref().map_or_else(|error| Status::NoModel(*error), |_| Status::Active)
    }

    /// What gives the friction, where there is something.
    #[must_use]
    pub fn source(&self) -> Option<&M> {
        self.model.as_ref().ok()
    }

    /// CRC-32 of the model as it is now in memory or flash: one that differs from that at the start is damaged. None where there is no model or it is
    /// code. Not for the control loop: it takes as long as the model is large.
    #[must_use]
    pub fn checksum(&self) -> Option<u32> {
        self.source()?.checksum()
    }

    /// Starts from zero torque, at rest and with nothing wound up; the warmth of the joint stays.
    pub fn reset(&mut self) {
        self.reset_by(M::rest);
    }

    /// Starts from zero torque with a model that `at_rest` puts to rest.
    pub fn reset_by(&mut self, at_rest: impl FnOnce(&mut M)) {
        if let Ok(model) = &mut self.model {
            at_rest(model);
        }
        self.output.release();
    }

    /// The compensation after a sample period of `dt` seconds. Call it at a fixed rate.
    ///
    /// Zero torque at once, and the slew starting from there, when anything that the model reads is missing or not finite or `dt` is not
    /// above 0 s and at most 1 s; what the effects remember is then as before. With a floating-point unit the number of instructions depends on the model alone.
    #[must_use]
    pub fn step(&mut self, measurement: &Measurement, dt: f32) -> Compensation {
        let model = match &mut self.model {
            Ok(model) => model,
            Err(error) => return Compensation { torque: 0.0, position: 0.0, status: Status::NoModel(*error) },
        };
        // No sample is longer than 1 s.
        let is_step = above_0_to_1(dt);
        let limits = self.output.limits();
        let share = model.share(limits.gain(), measurement, dt, is_step, limits.position());
        self.output.put_out(share, dt)
    }
}

impl<M: FrictionModel> Compensate for Limited<M> {
    fn limits(&self) -> &Limits {
        self.limits()
    }

    fn changes(&self) -> u32 {
        self.changes
    }

    fn step(&mut self, measurement: &Measurement, dt: f32) -> Compensation {
        self.step(measurement, dt)
    }
}
