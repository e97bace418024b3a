//! Choosing without a branch.

use core::hint::black_box;

/// Whether a sample is of use. Where it is not, everything is worked out all the same and nothing of it is kept, so that a step takes the
/// same time for every sample. A mask, of which the compiler does not know the value: it would turn a condition into a branch.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Usable(u32);

impl Usable {
    /// From what is negative where the sample is of use: [`finite`], [`from_0_to`], [`above_0_to`], and what is common to them by `&`.
    #[must_use]
    #[inline(always)]
    pub fn where_negative(sign: i32) -> Self {
        Self(black_box((sign >> 31) as u32))
    }

    /// As [`Usable::where_negative`], where so little depends on it that the compiler has nothing to go around.
    #[cfg(feature = "table")]
    #[inline(always)]
    pub(crate) fn where_negative_of_little(sign: i32) -> Self {
        Self((sign >> 31) as u32)
    }

    /// The condition.
    #[must_use]
    #[inline(always)]
    pub fn is_usable(self) -> bool {
        self.0 != 0
    }

    /// `now`, or `before` where the sample is of no use.
    #[must_use]
    #[inline(always)]
    pub fn or(self, now: f32, before: f32) -> f32 {
        f32::from_bits((now.to_bits() & self.0) | (before.to_bits() & !self.0))
    }

    /// `now`, or 0 where the sample is of no use.
    #[must_use]
    #[inline(always)]
    pub fn or_zero(self, now: f32) -> f32 {
        f32::from_bits(now.to_bits() & self.0)
    }
}

/// Negative where `x` is finite. In integers, for patterns order the magnitudes of floats: the flags of a floating-point comparison take
/// time to fetch.
#[must_use]
#[inline(always)]
pub fn finite(x: f32) -> i32 {
    (x.abs().to_bits() as i32).wrapping_sub(f32::INFINITY.to_bits() as i32)
}

/// Negative where `x` lies from 0 to `end`, which is positive and finite; -0 does not.
#[must_use]
#[inline(always)]
pub fn from_0_to(end: f32, x: f32) -> i32 {
    let bits = x.to_bits() as i32;
    bits.wrapping_sub(end.to_bits() as i32).wrapping_sub(1) & !bits
}

/// Negative where `x` lies above 0 and at most at `end`, which is positive and finite.
#[must_use]
#[inline(always)]
pub fn above_0_to(end: f32, x: f32) -> i32 {
    let bits = x.to_bits() as i32;
    let below = bits.wrapping_sub(1);
    below.wrapping_sub(end.to_bits() as i32) & !below
}

/// As [`above_0_to`] the end 1, of which the pattern is that of its exponent.
#[must_use]
#[inline(always)]
pub fn above_0_to_1(x: f32) -> i32 {
    const FRACTION_BITS: u32 = f32::MANTISSA_DIGITS - 1;
    let exponents_below = x.to_bits().wrapping_sub(1) >> FRACTION_BITS;
    exponents_below.wrapping_sub(1.0f32.to_bits() >> FRACTION_BITS) as i32
}

/// Negative where `x` is not 0.
#[must_use]
#[inline(always)]
pub fn not_zero(x: f32) -> i32 {
    (x.abs().to_bits() as i32).wrapping_neg()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn signs_are_conditions_for_every_kind_of_number() {
        let numbers = [0.0, 1.0e-45, 1.0e-38, 0.5, 1.0f32.next_down(), 1.0, 1.0f32.next_up(), 3.0e38, f32::MAX];
        let others = [f32::INFINITY, f32::NAN, f32::from_bits(0x7FFF_FFFF), f32::from_bits(0x7F80_0001)];
        for x in numbers.into_iter().chain(others).flat_map(|x| [x, -x]) {
            assert_eq!(Usable::where_negative(finite(x)).is_usable(), x.is_finite(), "{x}");
            assert_eq!(Usable::where_negative(not_zero(x)).is_usable(), x != 0.0, "{x}");
            assert_eq!(Usable::where_negative(above_0_to_1(x)).is_usable(), x > 0.0 && x <= 1.0, "{x}");
            for end in [1.0, f32::MAX] {
                let is_within = (0.0..=end).contains(&x) && x.is_sign_positive();
                assert_eq!(Usable::where_negative(from_0_to(end, x)).is_usable(), is_within, "{x} to {end}");
                assert_eq!(
                    Usable::where_negative(above_0_to(end, x)).is_usable(),
                    is_within && x > 0.0,
                    "{x} to {end}"
                );
            }
        }
    }

    #[test]
    fn what_is_of_no_use_is_not_kept() {
        let [used, unused] = [-1, 0].map(Usable::where_negative);
        assert_eq!((used.or(1.0, 2.0), used.or_zero(1.0)), (1.0, 1.0));
        assert_eq!((unused.or(1.0, 2.0), unused.or_zero(f32::NAN)), (2.0, 0.0));
    }
}
