//! Whether the compensation feeds the joint: a passivity observer with a gain that it lowers (after Hannaford & Ryu 2002).
//!
//! Friction and its compensation together have to dissipate: `(loop torque) v - d/dt(J v^2 / 2) >= 0`. Divided by the speed this is the net
//! friction of [`super::observer`].

use super::observer::Observation;
use super::pace::Pace;
use super::settings::Supervision;
use crate::bounds::within;

/// What the monitor remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Monitor {
    /// Share of the firmware's gain in force, 0 to 1.
    share: f32,
}

impl Monitor {
    /// Full gain.
    #[must_use]
    pub const fn new() -> Self {
        Self { share: 1.0 }
    }

    /// Share of the gain in force, 0 to 1.
    #[must_use]
    pub fn share(&self) -> f32 {
        self.share
    }

    /// Takes a sample with the friction of the model at its velocity, N m. The share falls while the net friction is negative, by the
    /// ratio of the two in `fall_time`, and rises by the same rule in `rise_time` while it is positive; it stays as it is unless
    /// the joint slides.
    pub fn take(&mut self, supervision: &Supervision, pace: &Pace, observed: &Observation, friction: f32) {
        let net = if observed.velocity < 0.0 { -observed.net_friction } else { observed.net_friction };
        let ratio = net / larger(friction.abs(), supervision.least_friction);
        let share = self.share + within(ratio, 1.0) * if ratio < 0.0 { pace.fall } else { pace.rise };
        let share = if share > 0.0 { share } else { 0.0 };
        let share = if share < 1.0 { share } else { 1.0 };
        self.share = if observed.slides { share } else { self.share };
    }
}

impl Default for Monitor {
    fn default() -> Self {
        Self::new()
    }
}

fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}
