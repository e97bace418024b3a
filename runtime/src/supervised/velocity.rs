//! The velocity of a joint as far as its encoder tells it: a count of a coarse one looks like a speed that no joint has.

use super::pace::Pace;

/// The velocity that is believed: that of the reference, and behind a low-pass what the measured one has beside it, so that a change that was
/// asked for is there at once and a count does little.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Velocity {
    /// rad/s.
    believed: f32,
    /// Velocity of the reference of the sample before, where there was one, rad/s.
    reference: Option<f32>,
}

impl Velocity {
    /// Takes a sample, all finite, and returns the velocity that is believed, rad/s.
    pub fn take(&mut self, pace: &Pace, measured: f32, reference: Option<f32>) -> f32 {
        let asked = match (self.reference, reference) {
            (Some(before), Some(now)) => now - before,
            _ => 0.0,
        };
        self.reference = reference;
        let expected = self.believed + asked;
        self.believed = expected + pace.velocity * (measured - expected);
        self.believed
    }
}
