//! What goes into a sample, and the friction that comes out of a model.

use frikan_shared::input::MAX_INPUTS;
#[cfg(feature = "models")]
use frikan_shared::{input::Input, units::Quantity};

use crate::usable::Usable;

/// What the drive knows of the joint in one sample, in SI. Channels that the model does not use may hold anything; one that it does use and
/// that is missing, NaN, gives no friction. By default every channel is missing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measurement {
    /// Velocity, measured or of the reference, rad/s.
    pub velocity: f32,
    /// Position, rad.
    pub position: f32,
    /// Acceleration, rad/s^2.
    pub acceleration: f32,
    /// Torque transmitted by the gear, N m.
    pub load: f32,
    /// Temperature, degC.
    pub temperature: f32,
    /// Channels without a standard quantity, in the order of the model's inputs.
    pub other: [f32; MAX_INPUTS],
}

impl Default for Measurement {
    fn default() -> Self {
        Self::MISSING
    }
}

impl Measurement {
    /// No channel is measured.
    pub const MISSING: Self = Self::all(f32::NAN);
    /// At rest, at the origin, unloaded, at 0 degC.
    pub const ZERO: Self = Self::all(0.0);

    const fn all(value: f32) -> Self {
        let other = [value; MAX_INPUTS];
        Self { velocity: value, position: value, acceleration: value, load: value, temperature: value, other }
    }
}

#[cfg(feature = "models")]
impl Measurement {
    /// The channels that `inputs` name, in their order; the rest is 0.
    #[must_use]
    pub fn channels(&self, inputs: &[Input]) -> [f32; MAX_INPUTS] {
        let mut channels = [0.0; MAX_INPUTS];
        let mut others = self.other.iter();
        for (channel, input) in channels.iter_mut().zip(inputs) {
            *channel = self.channel(&input.quantity, &mut others);
        }
        channels
    }

    /// The channel of a quantity; one without a standard quantity is the next of `others`.
    #[inline(always)]
    pub(crate) fn channel(&self, quantity: &Quantity, others: &mut core::slice::Iter<'_, f32>) -> f32 {
        match quantity {
            Quantity::Velocity => self.velocity,
            Quantity::Position => self.position,
            Quantity::Acceleration => self.acceleration,
            Quantity::Load => self.load,
            Quantity::Temperature => self.temperature,
            Quantity::Other(_) => others.next().copied().unwrap_or(0.0),
        }
    }
}

/// Friction of one sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Friction {
    /// Law and effects, within the model's output limit, in the unit of the model's output.
    pub torque: f32,
    /// What the effects add to the link's position against the motor's, rad.
    pub position: f32,
    /// Whether all that the model reads was finite; else there is no friction, and the memory is as it was.
    pub usable: Usable,
}
