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
    f32::from_bits(value.abs().to_bits().min(limit.to_bits()) | (value.to_bits() & SIGN_BIT))
}

/// 0 instead of `value` where `off`.
#[inline(always)]
pub(crate) fn unless(off: bool, value: f32) -> f32 {
    f32::from_bits(if off { 0 } else { value.to_bits() })
}
