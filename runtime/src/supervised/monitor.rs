//! Whether the compensation feeds the joint: a passivity observer with a gain that it lowers (after Hannaford & Ryu 2002).
//!
//! Friction and its compensation together have to dissipate: `(loop torque) v - d/dt(J v^2 / 2) >= 0`. Divided by the speed this is the net
//! friction of [`super::observer`].
//!
//! Over motions within the contact, where it is no friction yet, a budget of energy counts what the joint gives back: it may be what the contact
//! has stored, and no more.

use super::observer::Observation;
use super::pace::Pace;
use super::settings::Supervision;
use crate::bounds::within;

/// What the monitor remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Monitor {
    /// Share of the firmware's gain in force, 0 to 1.
    share: f32,
    /// Energy that friction and compensation have given to the joint beyond what they took from it, J: from 0 to that of a contact.
    given: f32,
}

impl Monitor {
    /// Full gain.
    #[must_use]
    pub const fn new() -> Self {
        Self { share: 1.0, given: 0.0 }
    }

    /// Share of the gain in force, 0 to 1.
    #[must_use]
    pub fn share(&self) -> f32 {
        self.share
    }

    /// Takes a sample with the friction of the model at its velocity, N m. The share falls while the net friction is negative, by the
    /// ratio of the two in `fall_time`, and rises by the same rule in `rise_time` while it is positive. It falls where the joint slides or has
    /// given back more than a contact stores, and rises where it slides and owes nothing.
    pub fn take(&mut self, supervision: &Supervision, pace: &Pace, observed: &Observation, friction: f32) {
        let Observation { net_friction, velocity, slides } = *observed;
        let net = if velocity < 0.0 { -net_friction } else { net_friction };
        let given =
            if velocity.abs() > pace.standstill { self.given - net * velocity.abs() * pace.dt } else { self.given };
        let given = if given > 0.0 { given } else { 0.0 };
        let is_overdrawn = given >= pace.elastic_energy;
        self.given = if is_overdrawn { pace.elastic_energy } else { given };
        let ratio = net / larger(friction.abs(), supervision.least_friction);
        let (may_change, change) =
            if ratio < 0.0 { (slides | is_overdrawn, pace.fall) } else { (slides & (given == 0.0), pace.rise) };
        if may_change {
            let share = self.share + change * within(ratio, 1.0);
            let share = if share > 0.0 { share } else { 0.0 };
            self.share = if share < 1.0 { share } else { 1.0 };
        }
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
