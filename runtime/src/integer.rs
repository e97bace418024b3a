//! Compensation in integers, for drives without floating-point unit: a velocity in counts goes in, a torque in counts comes out, and no
//! operation on floats is linked. The table lies in flash; a step takes the same number of instructions for every count.
//!
//! The numbers that a drive calculates with are whole numbers of units of its own, [`Units`]: counts of an encoder's velocity, per mille of the
//! rated torque, or a Q format, whose count is a power of two (in Q3.12 a count is `2^-12`). `trainer fit --target cortex-m0plus` makes the image for the
//! units of `[drive] velocity_count_rad_s` and `torque_count_Nm` of joint.toml, or chooses Q formats of 16 bits. The
//! steps of its table are those counts times powers of two, so that a count becomes steps by a shift, and steps become counts by a shift that
//! rounds to the nearest; an image for other counts is refused.
//!
//! ```
//! use frikan_runtime::integer::{IntegerCompensator, IntegerLimits, IntegerTableInPlace, ONE, Units};
//!
//! const UNITS: Units = Units { velocity: 1.0 / 4096.0, torque: 0.001 }; // rad/s and N m of a count
//! # let flash: &[u8] = &[];
//! let limits = IntegerLimits::new(ONE / 10 * 9, 4000, 800).unwrap(); // gain, counts, counts a step
//! let mut joint = IntegerCompensator::new(IntegerTableInPlace::at_start(flash, UNITS), limits);
//! assert_eq!(joint.step(1200), 0); // there is no image
//! ```
//!
//! As any bare compensator on a measured velocity it hunts where the gain is too high for the joint: the velocity of the reference is the better input.

mod limits;
mod presliding;
mod table;

pub use limits::{IntegerLimits, ONE};
pub use presliding::{IntegerPresliding, LARGEST_DISTANCE_COUNTS, PreslidingError};
pub use table::{IntegerTableInPlace, LARGEST_TORQUE_COUNTS, LARGEST_VELOCITY_COUNTS, Units};

use frikan_shared::image::ImageError;

use crate::compensator::Status;

/// Friction compensation of one joint in integers.
#[derive(Clone, Debug)]
pub struct IntegerCompensator<'a> {
    table: Result<IntegerTableInPlace<'a>, ImageError>,
    limits: IntegerLimits,
    /// What was put out last, counts.
    torque: i32,
}

impl<'a> IntegerCompensator<'a> {
    /// Compensation by a table, or off for the reason given.
    #[must_use]
    pub fn new(table: Result<IntegerTableInPlace<'a>, ImageError>, limits: IntegerLimits) -> Self {
        Self { table, limits, torque: 0 }
    }

    /// Goes on with another table, at the torque put out last, from where the slew limit leads; off at once where there is none.
    pub fn replace(&mut self, table: Result<IntegerTableInPlace<'a>, ImageError>) {
        if table.is_err() {
            self.torque = 0;
        }
        self.table = table;
    }

    /// Changes the limits between two steps; the slew limit holds across the change, that of a lower torque limit too.
    pub fn set_limits(&mut self, limits: IntegerLimits) {
        self.limits = limits;
    }

    /// Starts from zero torque: what a drive calls where it has no velocity, for there is no number that says so.
    pub fn reset(&mut self) {
        self.torque = 0;
    }

    /// Active, or why there is no table.
    #[must_use]
    pub fn status(&self) -> Status {
        self.table.as_ref().map_or_else(|error| Status::NoModel(*error), |_| Status::Active)
    }

    /// The torque to add, in counts, at a velocity in counts, whatever it is; 0 without a table. Call it at a fixed rate.
    #[must_use]
    #[inline]
    pub fn step(&mut self, velocity: i32) -> i32 {
        let Ok(table) = &self.table else { return 0 };
        self.torque = self.limits.approach(self.torque, table.friction(velocity));
        self.torque
    }

    /// As [`IntegerCompensator::step`], with the contact that bends before it slides; `position` in counts, which may wrap.
    #[must_use]
    #[inline]
    pub fn step_with(&mut self, presliding: &mut IntegerPresliding, velocity: i32, position: i32) -> i32 {
        let Ok(table) = &self.table else { return 0 };
        self.torque = self.limits.approach(self.torque, presliding.friction(table.friction(velocity), position));
        self.torque
    }

    /// The friction of the table at a velocity, both in counts, without limits; 0 without a table.
    #[must_use]
    pub fn friction(&self, velocity: i32) -> i32 {
        self.table.as_ref().map_or(0, |table| table.friction(velocity))
    }

    /// CRC-32 of the table as it is now in flash: one that differs from that at the start is damaged. Not for the control loop.
    #[must_use]
    pub fn checksum(&self) -> Option<u32> {
        self.table.as_ref().ok().map(IntegerTableInPlace::checksum)
    }
}

#[cfg(all(test, feature = "models"))]
mod tests;
