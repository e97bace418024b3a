//! Whether velocity and position tell of the same motion.

use super::pace::Pace;
use super::settings::Supervision;

/// What the check remembers.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Plausibility {
    /// Velocity less that of the position, behind a low-pass, rad/s.
    difference: f32,
    /// Speed behind the same low-pass, rad/s: the larger of the two.
    speed: f32,
    /// How long the two have contradicted each other, s.
    contradicted: f32,
}

/// Difference that is not one, as a share of the speed.
const TOLERATED_SHARE: f32 = 0.3;

impl Plausibility {
    /// Observes the velocity that is measured and that of the position, both finite, rad/s, and says whether it is to be believed: not after velocity and position have contradicted each
    /// other for `implausible_time`. One that stands still while the other moves contradicts it, and so does
    /// a wrong sign or a scale of 0.6 or 2.
    #[must_use]
    pub fn observe(&mut self, supervision: &Supervision, pace: &Pace, velocity: f32, of_position: f32) -> bool {
        let time = supervision.implausible_time;
        let faster = if of_position.abs() > velocity.abs() { of_position } else { velocity };
        self.difference += pace.plausibility * (velocity - of_position - self.difference);
        self.speed += pace.plausibility * (faster.abs() - self.speed);
        let tolerated = supervision.rest_velocity + pace.count_velocity + TOLERATED_SHARE * self.speed;
        let longer = self.contradicted + pace.dt;
        let longer = if longer < time { longer } else { time };
        self.contradicted = if self.difference.abs() > tolerated { longer } else { 0.0 };
        self.contradicted < time
    }
}
