//! The all-integer table: for targets without a floating-point unit, where even branch-free `f32` takes its time by the input.

use frikan_shared::integer_table::{REACH_BITS, WAY_BITS};
#[cfg(feature = "models")]
use frikan_shared::{
    integer_table::{IntegerTable, SEGMENT_BITS, SEGMENTS},
    pool::Pool,
};

/// The last step that is looked up; inputs beyond hold.
pub(crate) const LAST: i32 = (1 << REACH_BITS) - 1;

/// All ones for a negative number, else 0.
#[inline(always)]
pub(crate) fn sign(number: i32) -> i32 {
    number >> 31
}

/// A number, or 0 for a negative one.
#[inline(always)]
pub(crate) fn positive_part(number: i32) -> i32 {
    number & !sign(number)
}

/// The value of a cubic at the 16-bit way `x` through its cell, with its sign turned where `turned` is all ones instead of 0. No product is wider than
/// 32 bits.
#[inline(always)]
pub(crate) fn cubic([c0, c1, c2, c3]: [i32; 4], x: i32, turned: i32) -> i32 {
    let step = |sum: i32, coefficient: i32| coefficient.wrapping_add(sum.wrapping_mul(x) >> WAY_BITS);
    let value = step(step(step(c3, c2), c1), c0);
    (value ^ turned).wrapping_sub(turned)
}

/// The value of `table` at `input`, both in steps, in a fixed number of integer instructions: no comparison, no division, no
/// product wider than 32 bits.
#[cfg(feature = "models")]
#[must_use]
#[inline]
pub fn evaluate_integer<const CELLS: usize>(table: &IntegerTable, pool: &Pool<CELLS>, input: i32) -> i32 {
    let negative = sign(input);
    // Steps short of the last one, 0 beyond; the magnitude of `i32::MIN` is `2^31`, whose difference is negative again.
    let short = positive_part(LAST.wrapping_sub(input.wrapping_abs())) as u32;
    let segment = &table.segments[(short >> SEGMENT_BITS) as usize & (SEGMENTS - 1)];
    let place = segment
        .last
        .wrapping_sub(short.wrapping_mul(segment.factor))
        .wrapping_add(negative as u32 & table.negative_offset);
    let x = (place & ((1 << WAY_BITS) - 1)) as i32;
    cubic(pool.at(place >> WAY_BITS).integers(), x, negative & table.sign_mask)
}

/// The value at an input in the model's unit: rounded to the nearest step (saturating, NaN as 0), looked up, and scaled back.
#[cfg(feature = "models")]
#[must_use]
#[inline]
pub fn evaluate_steps<const CELLS: usize>(table: &IntegerTable, pool: &Pool<CELLS>, input: f32) -> f32 {
    let shape = table.shape();
    let steps = (input / shape.input_step + 0.5f32.copysign(input)) as i32;
    evaluate_integer(table, pool, steps) as f32 * shape.output_step
}
