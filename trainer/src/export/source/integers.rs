//! C of an integer table, in the counts of a drive without floating-point unit: the friction, and the step of the compensator within its limits.

use std::fmt::Write;

use frikan_runtime::integer::Units;
use frikan_shared::integer_table::{IntegerShape, SEGMENT_BITS, SEGMENTS, WAY_BITS};
use frikan_shared::model::{Law, Model};
use frikan_shared::table::{Cell, Symmetry};

use super::c::{Evaluator, header};
use super::law::identifier;
use crate::compile::integers::steps::IntegerReference;
use crate::error::{Error, Result, codes};
use crate::fit::CELLS;

/// The functions `NAME_friction` and `NAME_step` from and to counts of `units`, for which the table has to be made
/// ([`frikan_runtime::integer::IntegerTableInPlace`] says so). What of `name` C does not take becomes `_`.
///
/// # Errors
/// `FRK-U005` where the law is no integer table.
pub fn evaluator(name: &str, title: &str, model: &Model<CELLS>, units: Units) -> Result<Evaluator> {
    let (Law::IntegerTable(table), Some(reference)) = (&model.law, IntegerReference::new(model, units)) else {
        return Err(Error::new(&codes::UNSUITABLE_FORM, "the law is no integer table"));
    };
    let (stem, shape) = (identifier(name), table.shape());
    let friction = format!("int32_t {stem}_friction(int32_t velocity)");
    let step =
        format!("int32_t {stem}_step(int32_t before, int32_t velocity, uint16_t gain, uint16_t torque, uint16_t slew)");
    let prototypes =
        [(what_friction_is(model, units, reference.range()), friction.clone()), (STEP_IS.to_owned(), step.clone())];
    let cells = &model.cells[usize::from(shape.first_cell)..][..table.cells() as usize];
    let source = format!(
        "/* {title}. Made by `trainer export --to c`; do not edit. */\n#include \"{name}.h\"\n\n{SHIFTS}{}{}{FUNCTIONS}\
         {friction} {{\n{}}}\n\n{step} {{\n{}}}\n",
        segments(&shape),
        cells_in_c(cells),
        body_of_friction(&shape, units, reference.range()),
        body_of_step(&stem),
    );
    Ok(Evaluator { header: header(&stem, title, "#include <stdint.h>\n\n", &prototypes), source })
}

/// The comment of the friction.
fn what_friction_is(model: &Model<CELLS>, units: Units, [low, high]: [i64; 2]) -> String {
    let of_velocity = model.inputs.first().map_or("", |velocity| velocity.unit.symbol());
    let (velocity, torque, of_torque) = (units.velocity, units.torque, model.output_unit.symbol());
    format!(
        "/* Friction at a velocity, in counts of {torque:?} {of_torque} and of {velocity:?} {of_velocity}: 0 at rest, held below {low} and above {high}. It takes the same\n \
         * instructions for every velocity. */\n"
    )
}

/// The comment of the step.
const STEP_IS: &str = "/* The torque to add at a velocity, both in counts: gain, in 2^-15, of the friction, within the torque limit, and no more than the slew away from\n \
     * `before`, what this function returned in the step before; 0 in the first, and after a step without velocity. Call it at a fixed rate. */\n";

/// What every compiler for drives does, and no standard says before C23.
const SHIFTS: &str = "/* Shifts of negative numbers have to keep their sign. */\ntypedef char shifts_keep_the_sign[(-1 >> 1) == -1 ? 1 : -1];\n\n";

/// The first cell of each segment, and how many it has.
fn segments(shape: &IntegerShape) -> String {
    let mut start = 0u32;
    let rows: Vec<String> = shape
        .cells
        .iter()
        .map(|cells| {
            let row = format!("{{{start}, {cells}}}");
            start += u32::from(*cells);
            row
        })
        .collect();
    format!(
        "static const struct {{ uint16_t start; uint16_t cells; }} segments[{SEGMENTS}] = {{\n    {}\n}};\n\n",
        rows.join(", ")
    )
}

fn cells_in_c(cells: &[Cell]) -> String {
    let mut text = format!("static const struct {{ int32_t value; int16_t c[3]; }} cells[{}] = {{\n", cells.len());
    for cell in cells {
        let [value, a, b, c] = cell.integers();
        let _ = writeln!(text, "    {{{value}, {{{a}, {b}, {c}}}}},");
    }
    text + "};\n\n"
}

/// Bits by which `coarse` is more than `fine`, negative where it is less; both are the same but for a power of two.
fn bits_between(coarse: f32, fine: f32) -> i32 {
    (f64::from(coarse) / f64::from(fine)).log2().round() as i32
}

/// Statements of the friction; those of the drive (`runtime/src/integer/table.rs`), with its numbers.
fn body_of_friction(shape: &IntegerShape, units: Units, [low, high]: [i64; 2]) -> String {
    let input_bits = bits_between(units.velocity, shape.input_step);
    let steps = match input_bits {
        0 => "held".to_owned(),
        1.. => format!("held << {input_bits}"),
        _ => format!("held >> {}", -input_bits),
    };
    let reach = if -low == high { format!("{high}") } else { format!("{high} + (negative & {})", -low - high) };
    let side: u32 = shape.cells.iter().copied().map(u32::from).sum();
    let other_side = match shape.symmetry {
        Symmetry::Sided => format!(" + ((uint32_t)negative & {side}u)"),
        Symmetry::Odd | Symmetry::Even => String::new(),
    };
    let turned = if shape.symmetry == Symmetry::Odd { "(value ^ negative) - negative" } else { "value" };
    let (within, finer) = ((1u32 << SEGMENT_BITS) - 1, WAY_BITS - SEGMENT_BITS);
    let rounded = match bits_between(units.torque, shape.output_step) {
        0 => "signed_value".to_owned(),
        bits => format!("((signed_value + {}) >> {bits})", 1 << (bits - 1)),
    };
    format!(
        "    const int32_t negative = velocity >> 31;\n    \
         /* the negative of the magnitude, which even the least velocity has */\n    \
         const int32_t below = (velocity ^ ~negative) - ~negative;\n    \
         const int32_t reach = {reach};\n    \
         const uint32_t held = (uint32_t)(reach - positive_part(reach + below));\n    \
         const uint32_t steps = {steps};\n    \
         const uint32_t segment = steps >> {SEGMENT_BITS};\n    \
         const uint32_t way = (steps & {within:#X}u) * segments[segment].cells;\n    \
         const uint32_t cell = segments[segment].start + (way >> {SEGMENT_BITS}){other_side};\n    \
         const int32_t x = (int32_t)((way & {within:#X}u) << {finer});\n    \
         const int16_t *const c = cells[cell].c;\n    \
         const int32_t value = cells[cell].value + (((c[0] + (((c[1] + ((c[2] * x) >> {WAY_BITS})) * x) >> {WAY_BITS})) * x) >> {WAY_BITS});\n    \
         const int32_t signed_value = {turned};\n    \
         return {rounded} & (below >> 31);\n"
    )
}

/// What the friction and the step call.
const FUNCTIONS: &str = "static int32_t positive_part(int32_t number) { return number & ~(number >> 31); }\n\n\
     /* number within +-limit */\n\
     static int32_t within(int32_t number, int32_t limit) {\n    \
     return limit - positive_part(limit + limit - positive_part(number + limit));\n}\n\n";

/// Statements of the step.
fn body_of_step(stem: &str) -> String {
    format!(
        "    const int32_t share = ({stem}_friction(velocity) * gain + 0x4000) >> 15;\n    \
     return before + within(within(share, torque) - before, slew);\n"
    )
}
