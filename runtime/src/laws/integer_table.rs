//! The all-integer table: for targets without a floating-point unit, where even branch-free `f32` takes its time by the input.

use frikan_shared::integer_table::{IntegerTable, REACH_BITS, SEGMENT_BITS, SEGMENTS, WAY_BITS};
use frikan_shared::pool::Pool;

/// The last step that is looked up; inputs beyond hold.
const LAST: i32 = (1 << REACH_BITS) - 1;

/// The value of `table` at `input`, both in steps, in a fixed number of integer instructions: no comparison, no division, no
/// product wider than 32 bits.
#[must_use]
#[inline]
pub fn evaluate_integer<const CELLS: usize>(table: &IntegerTable, pool: &Pool<CELLS>, input: i32) -> i32 {
    // All ones for a negative input.
    let negative = input >> 31;
    // Steps short of the last one, 0 beyond; the magnitude of `i32::MIN` is `2^31`, whose difference is negative again.
    let short = LAST.wrapping_sub(input.wrapping_abs());
    let short = (short & !(short >> 31)) as u32;
    let segment = &table.segments[(short >> SEGMENT_BITS) as usize & (SEGMENTS - 1)];
    let place = segment
        .last
        .wrapping_sub(short.wrapping_mul(segment.factor))
        .wrapping_add(negative as u32 & table.negative_offset);
    let x = (place & ((1 << WAY_BITS) - 1)) as i32;
    let [c0, c1, c2, c3] = pool.at(place >> WAY_BITS).integers();
    let step = |sum: i32, coefficient: i32| coefficient.wrapping_add(sum.wrapping_mul(x) >> WAY_BITS);
    let value = step(step(step(c3, c2), c1), c0);
    let turned = negative & table.sign_mask;
    (value ^ turned).wrapping_sub(turned)
}

/// The value at an input in the model's unit: rounded to the nearest step (saturating, NaN as 0), looked up, and scaled back.
#[must_use]
#[inline]
pub fn evaluate_steps<const CELLS: usize>(table: &IntegerTable, pool: &Pool<CELLS>, input: f32) -> f32 {
    let shape = table.shape();
    let steps = (input / shape.input_step + 0.5f32.copysign(input)) as i32;
    evaluate_integer(table, pool, steps) as f32 * shape.output_step
}
