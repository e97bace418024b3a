//! Limits of the firmware, in counts.

use super::table::LARGEST_TORQUE_COUNTS;
use crate::compensator::LimitError;
use crate::laws::integer_table::positive_part;

/// Gain of one: gains are whole numbers of `2^-15`.
pub const ONE: u16 = 1 << GAIN_BITS;

/// Fraction bits of a gain.
const GAIN_BITS: u32 = 15;

/// Limits of the firmware, all in force at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IntegerLimits {
    gain: i32,
    torque: i32,
    slew: i32,
}

impl IntegerLimits {
    /// No compensation at all.
    pub const OFF: Self = Self { gain: 0, torque: 0, slew: LARGEST_CHANGE };

    /// `gain`: share of the friction that is compensated, in `2^-15`, at most [`ONE`]; `torque`: largest torque put out, counts, at most
    /// [`LARGEST_TORQUE_COUNTS`]; `slew`: its largest change in a step, counts, at least 1.
    ///
    /// # Errors
    /// [`LimitError`] where one of them is out of its range.
    pub fn new(gain: u16, torque: u16, slew: u16) -> Result<Self, LimitError> {
        let [gain, torque, slew] = [gain, torque, slew].map(i32::from);
        if gain > i32::from(ONE) {
            Err(LimitError::Gain)
        } else if torque > LARGEST_TORQUE_COUNTS {
            Err(LimitError::Torque)
        } else if slew == 0 {
            Err(LimitError::Slew)
        } else {
            Ok(Self { gain, torque, slew })
        }
    }

    /// As near to the gain's share of `friction` as the torque limit allows and a change of at most the slew from `torque`. `friction` is at most
    /// twice [`LARGEST_TORQUE_COUNTS`], and `torque` at most that, so that no product and no sum overflows.
    #[inline(always)]
    pub(super) fn approach(&self, torque: i32, friction: i32) -> i32 {
        let share = friction.wrapping_mul(self.gain).wrapping_add(1 << (GAIN_BITS - 1)) >> GAIN_BITS;
        let change = within(share, self.torque).wrapping_sub(torque);
        torque.wrapping_add(within(change, self.slew))
    }
}

/// Largest difference of two torques.
const LARGEST_CHANGE: i32 = 2 * LARGEST_TORQUE_COUNTS;

/// A number of at most `2^30` held to `[-limit, limit]`, `limit` being at least 0 and at most `2^17`, without a comparison.
#[inline(always)]
pub(super) fn within(number: i32, limit: i32) -> i32 {
    let above_least = positive_part(number.wrapping_add(limit));
    limit.wrapping_sub(positive_part(limit.wrapping_add(limit).wrapping_sub(above_least)))
}
