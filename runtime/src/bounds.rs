//! Holding a number within bounds without a comparison of floats.

use frikan_shared::table::SIGN_BIT;

/// `value` held to `[-limit, limit]`; zero for NaN. `limit` must not be NaN, and its sign does not count.
///
/// In integers, which order the magnitudes of floats as their bits: no comparison of floats, whose flags take time to fetch.
#[must_use]
#[inline(always)]
pub fn limited(value: f32, limit: f32) -> f32 {
    let magnitude = value.abs().to_bits();
    let held = magnitude.min(limit.abs().to_bits()) | (value.to_bits() & SIGN_BIT);
    unless(magnitude > f32::INFINITY.to_bits(), f32::from_bits(held))
}

/// `value` held to `[-limit, limit]`, for values and limits that are no NaN and limits that are not negative; some number for others.
#[must_use]
#[inline(always)]
pub(crate) fn within(value: f32, limit: f32) -> f32 {
    let at_limit = limit.to_bits() | (value.to_bits() & SIGN_BIT);
    f32::from_bits(if value.abs().to_bits() > limit.to_bits() { at_limit } else { value.to_bits() })
}

/// What of `value` lies beyond `[-limit, limit]`: its distance from there with its sign, 0 without a sign within. For values and limits that are no NaN and
/// limits that are not negative; some number for others.
#[must_use]
#[inline(always)]
pub(crate) fn beyond(value: f32, limit: f32) -> f32 {
    let left = (limit - value.abs()).to_bits();
    // Where nothing is left, what is beyond without its sign, which is that of the value.
    let is_beyond = (left as i32 >> 31) as u32;
    f32::from_bits(left & is_beyond & (value.to_bits() | !SIGN_BIT))
}

/// 0 instead of `value` where `off`.
#[inline(always)]
pub(crate) fn unless(off: bool, value: f32) -> f32 {
    f32::from_bits(if off { 0 } else { value.to_bits() })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Numbers of every magnitude, and both zeros.
    fn number() -> impl Strategy<Value = f32> {
        prop_oneof![
            8 => any::<u32>().prop_map(f32::from_bits).prop_filter("finite", |number| number.is_finite()),
            1 => prop_oneof![Just(0.0), Just(-0.0), Just(1.0), Just(-1.0)],
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(20_000))]

        /// The bits are those of what is within taken from the whole.
        #[test]
        fn what_is_beyond_is_what_is_left_of_what_is_within(value in number(), limit in number(), whole in number()) {
            let value = within(value, 0.25 * f32::MAX);
            let limit = limit.abs();
            for limit in [limit, value.abs(), value.abs().next_up(), value.abs().next_down().abs()] {
                let left = value - within(value, limit);
                prop_assert_eq!((whole - beyond(value, limit)).to_bits(), (whole - left).to_bits(), "{} {}", value, limit);
            }
        }

        #[test]
        fn within_is_the_clamp_of_comparisons(value in number(), limit in number()) {
            let limit = limit.abs();
            prop_assert_eq!(within(value, limit), value.clamp(-limit, limit));
            prop_assert_eq!(within(value, limit).is_sign_negative(), value.is_sign_negative());
        }
    }
}
