//! Whether velocity and position tell of the same motion.

use super::pace::Pace;
use super::settings::{FASTEST, Supervision};
use crate::bounds::limited;

/// What the check remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Plausibility {
    /// Position of the sample before, rad.
    before: Option<f32>,
    /// Velocity less that of the position, behind a low-pass, rad/s.
    difference: f32,
    /// Speed behind the same low-pass, rad/s: the larger of the two.
    speed: f32,
    /// How long the two have contradicted each other, s.
    contradicted: f32,
}

/// Difference that is not one, as a share of the speed.
const TOLERATED_SHARE: f32 = 0.5;

impl Plausibility {
    /// Observes a sample, all finite, and says whether it is to be believed: not after velocity and position have contradicted each
    /// other for `implausible_time`. One that stands still while the other moves contradicts it, and so does a wrong sign.
    #[must_use]
    pub fn observe(&mut self, supervision: &Supervision, pace: &Pace, velocity: f32, position: f32) -> bool {
        let time = supervision.implausible_time;
        let of_position = limited((position - self.before.unwrap_or(position)) * pace.rate, FASTEST);
        self.before = Some(position);
        let faster = if of_position.abs() > velocity.abs() { of_position } else { velocity };
        self.difference += pace.plausibility * (velocity - of_position - self.difference);
        self.speed += pace.plausibility * (faster.abs() - self.speed);
        let tolerated = supervision.rest_velocity + TOLERATED_SHARE * self.speed;
        let longer = self.contradicted + pace.dt;
        let longer = if longer < time { longer } else { time };
        self.contradicted = if self.difference.abs() > tolerated { longer } else { 0.0 };
        self.contradicted < time
    }
}
