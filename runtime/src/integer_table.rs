//! The all-integer table: for targets without a floating-point unit, where even branch-free `f32` takes its time by the input.

use frikan_shared::integer_table::IntegerTable;
use frikan_shared::pool::Pool;

/// The value of `table` at `input`, both in steps, in a fixed number of integer instructions: no division, no product wider than
/// 32 bits.
#[must_use]
#[inline]
pub fn evaluate_integer<const CELLS: usize>(table: &IntegerTable, pool: &Pool<CELLS>, input: i32) -> i32 {
    // All ones for a negative input.
    let negative = input >> 31;
    let magnitude = (input ^ negative).wrapping_sub(negative) as u32;
    let position = magnitude.min(table.last);
    let [inner, outer] = &table.zones;
    let zone = if position.wrapping_shr(table.split_shift) == 0 { inner } else { outer };
    let cell = zone
        .first_cell
        .wrapping_add(position.wrapping_shr(zone.shift))
        .wrapping_add(negative as u32 & table.negative_offset);
    let x = (position & 1u32.wrapping_shl(zone.shift).wrapping_sub(1)) as i32;
    let [c0, c1, c2, c3] = pool.at(cell).integers();
    let step = |sum: i32, coefficient: i32| coefficient.wrapping_add(sum.wrapping_mul(x).wrapping_shr(zone.shift));
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
