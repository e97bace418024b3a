//! A law that was exported as source, in place of an image.

use super::limited::FrictionModel;
use crate::bounds::within;
use crate::measurement::{Friction, Measurement};
use crate::usable::{Usable, finite};

/// A law that is compiled in, such as `trainer export --to rust` writes it: from the channels of a sample and its period, s, to the friction
/// torque.
///
/// It is of use where velocity and torque are finite; a law that reads another channel gives NaN where that is missing. A law with a memory
/// of its own goes on with it through a reset.
///
/// ```
/// use frikan_runtime::compensator::{Exported, Limited, Limits, Status};
/// use frikan_runtime::measurement::Measurement;
///
/// let law = |sample: &Measurement, _dt: f32| 2.0 * sample.velocity.clamp(-0.1, 0.1) / 0.1;
/// let mut joint = Limited::by(Ok(Exported(law)), Limits::new(0.9, 5.0, 1.0e6).unwrap());
/// let answer = joint.step(&Measurement { velocity: 0.5, ..Measurement::MISSING }, 1.0e-3);
/// assert_eq!((answer.torque, answer.status), (1.8, Status::Active));
/// assert_eq!(joint.step(&Measurement::MISSING, 1.0e-3).status, Status::NotFinite);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Exported<F>(pub F);

impl<F: FnMut(&Measurement, f32) -> f32> FrictionModel for Exported<F> {
    #[inline(always)]
    fn friction(&mut self, measurement: &Measurement, dt: f32, is_step: i32, _: f32) -> Friction {
        // A period that is none is not handed over: the law may remember it.
        if is_step >= 0 {
            return Friction::default();
        }
        let torque = (self.0)(measurement, dt);
        let usable = Usable::where_negative(finite(measurement.velocity) & finite(torque));
        Friction { torque: within(torque, LARGEST_FRICTION), position: 0.0, usable }
    }

    fn rest(&mut self) {}
}

/// Torque beyond any joint's; a gain does not make it infinite.
const LARGEST_FRICTION: f32 = 1.0e9;
