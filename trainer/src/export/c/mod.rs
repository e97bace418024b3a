//! A law as C source without dependency: one .c and one .h whose function computes the very bits of the runtime. The source keeps the compiler
//! from contracting a product and a sum, and refuses the options by which it would not round every operation by itself.

mod program;

use std::fmt::Write;

use frikan_shared::image::Image;
use frikan_shared::model::{Input, Law, Model};
use frikan_shared::table::{Cell, Geometric, Uniform};
use frikan_shared::units::Quantity;

use crate::error::{Error, Result, codes};
use crate::fit::CELLS;

/// The C functions that an evaluator may call, each separated by a blank line from the next and after those that it calls itself.
const FUNCTIONS: &str = include_str!("functions.c");

/// The two files of an evaluator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Evaluator {
    /// `NAME.h`.
    pub header: String,
    /// `NAME.c`.
    pub source: String,
}

/// The evaluator of an image's static law, as the function `NAME_friction`. What of `name` C does not take becomes `_`.
///
/// # Errors
/// `FRK-U005` for a law or a correction that has no such form: networks, integer tables and effects with a memory need the library.
pub fn evaluator(name: &str, title: &str, image: &Image<CELLS>) -> Result<Evaluator> {
    let model = &image.model;
    if !model.effects.is_empty() {
        return Err(refusal("corrections remember what was before; they need the library"));
    }
    let names: Vec<String> = model.inputs.iter().map(parameter).collect();
    let mut body = String::new();
    // Writing to a string cannot fail.
    let _ = match &model.law {
        Law::Geometric(layout) => geometric(&mut body, layout, &names[0]),
        Law::Uniform(layout) => uniform(&mut body, layout, &names[0], model.output_limit),
        Law::Expression(program) => program::statements(&mut body, program, &model.inputs, &names, model.output_limit),
        Law::Network(_) => return Err(refusal("a network has no form in C; it needs the library")),
        Law::IntegerTable(_) => return Err(refusal("an integer table has no form in C; it needs the library")),
    };
    let parameters: Vec<String> = names.iter().map(|name| format!("float {name}")).collect();
    let stem = identifier(name);
    let prototype = format!("float {stem}_friction({})", parameters.join(", "));
    let cells = if model.cells.is_empty() { String::new() } else { cells(&model.cells) };
    let functions = needed(&body);
    Ok(Evaluator {
        header: header(&stem, title, model, &names, &prototype),
        source: format!("{}{functions}{cells}{prototype} {{\n{body}}}\n", preamble(name, title)),
    })
}

fn refusal(reason: &str) -> Error {
    Error::new(&codes::UNSUITABLE_FORM, reason)
}

fn preamble(name: &str, title: &str) -> String {
    format!(
        "/* {title}. Made by `trainer export --to c`; do not edit.\n \
         * Every operation is rounded by itself: no -ffast-math, nor what is part of it. */\n\
         #include \"{name}.h\"\n\n#include <float.h>\n#include <stdint.h>\n\n\
         #if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || FLT_EVAL_METHOD != 0\n\
         #error \"float operations must be rounded one by one, to float\"\n#endif\n\
         #if defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0\n\
         #error \"an input that is NaN must be told from a number: compile without -ffinite-math-only\"\n#endif\n\
         #if defined(__GNUC__) && !defined(__clang__)\n#pragma GCC optimize (\"fp-contract=off\")\n\
         #else\n#pragma STDC FP_CONTRACT OFF\n#endif\n\n"
    )
}

fn header(stem: &str, title: &str, model: &Model<CELLS>, names: &[String], prototype: &str) -> String {
    let guard = format!("{}_H", stem.to_ascii_uppercase());
    let mut text = format!("/* {title}. Made by `trainer export --to c`; do not edit. */\n");
    let _ = write!(text, "#ifndef {guard}\n#define {guard}\n\n#ifdef __cplusplus\nextern \"C\" {{\n#endif\n\n");
    let _ = writeln!(
        text,
        "/* Friction in {}, at most {:?}; 0 where an input is NaN.",
        model.output_unit.symbol(),
        model.output_limit
    );
    for (input, name) in model.inputs.iter().zip(names) {
        let (low, high, unit) = (input.low, input.high, input.unit.symbol());
        let _ = writeln!(text, " * {name}: {low:?} to {high:?} {unit}, held at the nearer end outside.");
    }
    let _ = write!(text, " */\n{prototype};\n\n#ifdef __cplusplus\n}}\n#endif\n\n#endif\n");
    text
}

/// The functions of [`FUNCTIONS`] that `body` calls, and those that these call, in their order.
fn needed(body: &str) -> String {
    let mut kept: Vec<&str> = Vec::new();
    for function in FUNCTIONS.trim_end().split("\n\n").collect::<Vec<_>>().into_iter().rev() {
        let call = format!("{}(", defined_name(function));
        if kept.iter().chain([&body]).any(|text| text.contains(&call)) {
            kept.push(function);
        }
    }
    kept.iter().rev().map(|function| format!("{function}\n\n")).collect()
}

/// The name of the function that a piece of C defines: what stands before its first bracket, comments aside.
fn defined_name(function: &str) -> &str {
    let definition = function.split_once("static ").map_or("", |(_, rest)| rest);
    definition.split_once('(').map_or("", |(head, _)| head).rsplit(' ').next().unwrap_or("")
}

fn cells(cells: &[Cell]) -> String {
    let mut text = format!("static const float cells[{}][4] = {{\n", cells.len());
    for cell in cells {
        let coefficients: Vec<String> = cell.floats().into_iter().map(literal).collect();
        let _ = writeln!(text, "    {{{}}},", coefficients.join(", "));
    }
    text.push_str("};\n\n");
    text
}

fn geometric(out: &mut String, layout: &Geometric, input: &str) -> std::fmt::Result {
    let [positive, negative] = &layout.sides;
    let offset = literal(layout.offset);
    writeln!(out, "    const int negative = (int)(bits_of({input}) >> 31);")?;
    for (name, ends) in [
        ("origin", [positive.origin, negative.origin]),
        ("last", [positive.last_position, negative.last_position]),
        ("cells_per_turn", [positive.cells_per_turn, negative.cells_per_turn]),
        ("sign", [positive.sign, negative.sign]),
    ] {
        let [positive, negative] = ends;
        writeln!(out, "    const uint32_t {name} = negative ? {negative:#x}u : {positive:#x}u;")?;
    }
    writeln!(out, "    const uint32_t width = bits_of(magnitude_of({input}) + {offset});")?;
    writeln!(out, "    const uint32_t position = width - origin < last ? width - origin : last;")?;
    writeln!(out, "    const uint64_t product = (uint64_t)position * cells_per_turn;")?;
    writeln!(out, "    const float value = cubic(cells[product >> 32], way(product));")?;
    writeln!(out, "    return width > 0x7f800000u ? 0.0f : float_of(bits_of(value) ^ sign);")
}

fn uniform(out: &mut String, layout: &Uniform, input: &str, limit: f32) -> std::fmt::Result {
    let (low, scale) = (literal(layout.low), literal(layout.scale));
    writeln!(out, "    const uint32_t position = saturated(({input} - {low}) * {scale});")?;
    writeln!(out, "    const uint64_t product = (uint64_t)position * {}u;", layout.cells)?;
    writeln!(out, "    const float value = cubic(cells[{}u + (product >> 32)], way(product));", layout.first_cell)?;
    writeln!(out, "    return {input} != {input} ? 0.0f : limited(value, {});", literal(limit))
}

/// A finite number that reads back to the same bits; a negative one in brackets.
fn literal(x: f32) -> String {
    if x.is_sign_negative() { format!("({x:?}f)") } else { format!("{x:?}f") }
}

/// The name of a channel as a parameter.
fn parameter(input: &Input) -> String {
    match &input.quantity {
        Quantity::Other(name) => format!("channel_{}", identifier(name)),
        quantity => quantity.name().to_owned(),
    }
}

/// A name as C takes it.
fn identifier(name: &str) -> String {
    let mut identifier: String = name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect();
    if identifier.starts_with(|c: char| c.is_ascii_digit()) || identifier.is_empty() {
        identifier.insert(0, '_');
    }
    identifier
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_function_has_a_name_and_brings_what_it_calls() {
        let names: Vec<&str> = FUNCTIONS.trim_end().split("\n\n").map(defined_name).collect();
        assert!(names.iter().all(|name| !name.is_empty()) && names.contains(&"f_square_root"), "{names:?}");
        let cosine = needed("f_cos(x)");
        for name in ["float_of(", "bits_of(", "magnitude_of(", "at_most(", "sin_half_turn(", "less_half_turns("] {
            assert!(cosine.contains(name), "{name}");
        }
        assert!(!cosine.contains("f_sin(") && !cosine.contains("f_exp(") && !cosine.contains("at_least("), "{cosine}");
        assert_eq!(needed("x + 1.0f"), "");
    }

    #[test]
    fn names_become_identifiers() {
        assert_eq!(identifier("elbow-2"), "elbow_2");
        assert_eq!(identifier("2nd joint"), "_2nd_joint");
        assert_eq!(literal(-0.5), "(-0.5f)");
        assert_eq!(literal(1.0e-7), "1e-7f");
    }
}
