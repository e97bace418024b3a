//! The torque of a joint that stands still where it is to: as it was, for a time. To switch it would move the joint, and to hold it for ever would
//! trust for ever what was true when the joint came to rest.

use super::pace::Pace;

/// What is held.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Rest {
    /// Compensation of the last sample in motion, before the share of the monitor.
    torque: f32,
    /// How long the joint has stood still, in hold times, 2 at most.
    stood: f32,
}

impl Rest {
    /// The compensation of a sample in motion.
    pub fn moving(&mut self, wanted: f32) -> f32 {
        *self = Self { torque: wanted, stood: 0.0 };
        wanted
    }

    /// The compensation of a joint at rest: what it was, and from one hold time to the next falling to 0.
    pub fn standing(&mut self, pace: &Pace) -> f32 {
        let stood = self.stood + pace.hold;
        self.stood = if stood < 2.0 { stood } else { 2.0 };
        let left = 2.0 - self.stood;
        self.torque * if left < 1.0 { left } else { 1.0 }
    }
}
