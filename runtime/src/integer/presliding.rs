//! Presliding in counts: after a reversal friction turns over across a distance, as [`frikan_shared::effect::Effect::Presliding`] with one element has it.

use super::limits::within;
use super::table::LARGEST_TORQUE_COUNTS;
use crate::laws::integer_table::{positive_part, sign};

/// Why a presliding is refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum PreslidingError {
    /// The torque is more than the least friction while sliding, or that is 0 or more than [`LARGEST_TORQUE_COUNTS`].
    Torque,
    /// The distance is 0 or more than [`LARGEST_DISTANCE_COUNTS`].
    Distance,
}

impl core::fmt::Display for PreslidingError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Torque => "the torque of presliding is not from 0 to the least friction while sliding",
            Self::Distance => "the distance of presliding is not from 1 count to 2^20",
        })
    }
}

impl core::error::Error for PreslidingError {}

/// Most counts of a distance.
pub const LARGEST_DISTANCE_COUNTS: u32 = 1 << 20;

/// A contact that bends before it slides (Dahl 1968), in counts of torque and position. Beside the friction `F` of the table it puts out
/// `torque z - s`: the element `z <- z r + (1 - r) S`, `r = exp(-|dq| / distance)`, `S` the sign of `dq`, in place of the share
/// `s = torque F / least_friction` of the table, at most `torque`, that reverses with the velocity. Stiffness at a reversal is `2 torque / distance`.
///
/// ```
/// use frikan_runtime::integer::IntegerPresliding;
///
/// // 300 counts of torque turn over across 40 counts of the encoder; sliding the joint never has less than 350 counts of friction.
/// const CONTACT: IntegerPresliding = match IntegerPresliding::new(300, 40, 350) {
///     Ok(contact) => contact,
///     Err(_) => panic!("out of range"),
/// };
/// let mut contact = CONTACT;
/// assert_eq!(contact.friction(0, 1000), 0); // the first position is where it begins, relaxed
/// assert_eq!(contact.friction(350, 9000), 350); // long after a reversal the friction is that of the table
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct IntegerPresliding {
    torque: i32,
    /// The share of the table's friction that reverses with the velocity, in `2^-15`.
    part: i32,
    /// Halvings for each count of the way, in `2^-27`.
    halvings: u32,
    /// Counts behind which nothing is left, and counts from which a way is kept: what is shorter is gathered, for it would be lost
    /// in rounding.
    most: i32,
    least: i32,
    /// How far the element is stretched, in `2^-15`, from -1 to 1.
    share: i32,
    /// Position up to which the way was taken, counts, and all ones where there is one.
    before: i32,
    started: i32,
}

/// Fraction bits of shares.
const SHARE_BITS: u32 = 15;
const ONE: i32 = 1 << SHARE_BITS;
/// Half of what is shifted out.
const HALF: i32 = ONE >> 1;

/// Bits of [`IntegerPresliding::halvings`] and those that are left of a number of halvings.
const HALVINGS_BITS: u32 = 27;
const LEFT_BITS: u32 = 16;

/// `log2 e` in `2^-27`.
const LOG2_E: u32 = 193_635_251;

/// Distances behind which less than a share's last bit is left: `exp(-16) < 2^-23`.
const DISTANCES: u32 = 16;

/// Parts of the distance from which a way is taken.
const PARTS: u32 = 256;

impl IntegerPresliding {
    /// `torque`, counts, is what turns over after a reversal, across `distance` counts of the position, 1 to [`LARGEST_DISTANCE_COUNTS`]; `least_friction`,
    /// counts, is the least that the table has while the joint slides, at least `torque`: where the table has less, it passes through zero.
    ///
    /// # Errors
    /// [`PreslidingError`] where one of them is out of its range.
    pub const fn new(torque: u16, distance: u32, least_friction: u16) -> Result<Self, PreslidingError> {
        let [torque, least_friction] = [torque as i32, least_friction as i32];
        if torque > least_friction || least_friction == 0 || least_friction > LARGEST_TORQUE_COUNTS {
            return Err(PreslidingError::Torque);
        }
        if distance == 0 || distance > LARGEST_DISTANCE_COUNTS {
            return Err(PreslidingError::Distance);
        }
        Ok(Self {
            torque,
            // Rounded up, so that the whole torque is reached.
            part: ((torque << SHARE_BITS) + least_friction - 1) / least_friction,
            halvings: (LOG2_E + distance / 2) / distance,
            most: (DISTANCES * distance) as i32,
            least: distance.div_ceil(PARTS) as i32,
            share: 0,
            before: 0,
            started: 0,
        })
    }

    /// At rest and relaxed; the next position is where it begins.
    pub const fn reset(&mut self) {
        self.share = 0;
        self.started = 0;
    }

    /// The friction with presliding, counts, from that of the table and the position, counts, which may wrap: less than twice the largest torque. Takes no
    /// comparison, no division and no product wider than 32 bits.
    #[inline(always)]
    pub fn friction(&mut self, friction: i32, position: i32) -> i32 {
        let way = position.wrapping_sub(self.before) & self.started;
        let direction = sign(way);
        let length = (way ^ direction).wrapping_sub(direction) as u32;
        // All ones where the way is long enough, or the position is the first one.
        let taken = !sign((length as i32).wrapping_sub(self.least)) | !self.started;
        let held = self.most.wrapping_sub(positive_part(self.most.wrapping_sub(length as i32)));
        let end = (ONE ^ direction).wrapping_sub(direction);
        let left = halved((held as u32).wrapping_mul(self.halvings) >> (HALVINGS_BITS - LEFT_BITS));
        // From the end of the way, at most twice one.
        let rest = ((end.wrapping_sub(self.share) ^ direction).wrapping_sub(direction) as u32)
            .wrapping_mul(left)
            .wrapping_add(HALF as u32)
            >> SHARE_BITS;
        let now = end.wrapping_sub((rest as i32 ^ direction).wrapping_sub(direction));
        let now = self.share ^ ((self.share ^ now) & self.started);
        self.share ^= (self.share ^ now) & taken;
        self.before ^= (self.before ^ position) & taken;
        self.started = -1;
        let rounded = |product: i32| product.wrapping_add(HALF) >> SHARE_BITS;
        let reversing = within(rounded(friction.wrapping_mul(self.part)), self.torque);
        friction.wrapping_sub(reversing).wrapping_add(rounded(self.torque.wrapping_mul(now)))
    }
}

/// `2^-x` in `2^-15`, `x` in `2^-16` and below 32, off by `1.1e-4` of it at most: a half, a quarter and so on for what is whole, and
/// `1 - f / 2 - f (1 - f) (a + b f)` for the rest, with least error.
#[inline(always)]
fn halved(x: u32) -> u32 {
    const A: i32 = 6284;
    const B: i32 = -1296;
    let f = (x >> (LEFT_BITS - SHARE_BITS)) as i32 & (ONE - 1);
    let bend = (f.wrapping_mul(ONE.wrapping_sub(f)) >> SHARE_BITS)
        .wrapping_mul(A.wrapping_add(B.wrapping_mul(f) >> SHARE_BITS))
        >> SHARE_BITS;
    (ONE.wrapping_sub(f >> 1).wrapping_sub(bend) as u32).wrapping_shr(x >> LEFT_BITS)
}

#[cfg(all(test, feature = "models"))]
mod tests;
