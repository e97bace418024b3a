//! C: one .c and one .h. The source keeps the compiler from contracting a product and a sum, and refuses the options by which it would not
//! round every operation by itself.

use std::fmt::Write;

use frikan_shared::image::Image;
use frikan_shared::model::Model;

use super::language::Language;
use super::law::{identifier, law, no_law, parameters, reads_position, step, unusable};
use super::library;
use super::lookup::cells;
use crate::error::Result;
use crate::fit::CELLS;

/// The two files of an evaluator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Evaluator {
    /// `NAME.h`.
    pub header: String,
    /// `NAME.c`.
    pub source: String,
}

/// The evaluator of an image: the static law as the function `NAME_friction`, and, where there are effects, law and effects as the function
/// `NAME_step` of a `NAME_state`. What of `name` C does not take becomes `_`.
///
/// # Errors
/// `FRK-U005` for an integer table: [`super::integers`] has it.
pub fn evaluator(name: &str, title: &str, image: &Image<CELLS>) -> Result<Evaluator> {
    let model = &image.model;
    let stem = identifier(name);
    let names: Vec<String> = parameters(model).into_iter().map(|name| format!("float {name}")).collect();
    let prototype = format!("float {stem}_friction({})", names.join(", "));
    let mut functions = format!("{prototype} {{\n{}}}\n", indented(&law(Language::C, model)?));
    let mut prototypes = vec![(what_friction_is(model), prototype)];
    if !model.effects.is_empty() {
        let prototype = format!("float {stem}_step({stem}_state *state, float dt, {})", names.join(", "));
        let _ = write!(functions, "\n{prototype} {{\n{}}}\n", indented(&body_of_step(model, &stem)));
        prototypes.push((state(model, &stem), prototype));
    }
    let cells = cells(Language::C, model, &functions);
    let library = library::needed(Language::C, &functions);
    Ok(Evaluator {
        header: header(&stem, title, "", &prototypes),
        source: format!("{}{library}{cells}{functions}", preamble(name, title)),
    })
}

fn indented(statements: &[String]) -> String {
    statements.iter().map(|statement| format!("    {statement}\n")).collect()
}

fn body_of_step(model: &Model<CELLS>, stem: &str) -> Vec<String> {
    let mut body = vec![
        "struct motion m = {0};".to_owned(),
        "float torque, place = 0.0f;".to_owned(),
        "state->position = 0.0f;".to_owned(),
        Language::C.return_where(&unusable(Language::C, model), 0.0),
    ];
    body.extend(step(Language::C, model, &format!("{stem}_friction")));
    body.push("state->position = place;".to_owned());
    body.push(format!("return limited(torque, {});", Language::C.number(model.output_limit)));
    body
}

fn what_friction_is(model: &Model<CELLS>) -> String {
    let mut text = format!(
        "/* The static law in {}, at most {:?}; 0 where {}.\n",
        model.output_unit.symbol(),
        model.output_limit,
        no_law(model)
    );
    for (input, name) in model.inputs.iter().zip(parameters(model)) {
        let (low, high, unit) = (input.low, input.high, input.unit.symbol());
        let _ = writeln!(text, " * {name}: {low:?} to {high:?} {unit}, held at the nearer end outside.");
    }
    text + " */\n"
}

fn state(model: &Model<CELLS>, stem: &str) -> String {
    let travel = if reads_position(model) { "    float travel[4];\n" } else { "" };
    format!(
        "/* What the effects remember; all zero at the start. `position` is what the last step adds to the link's position. */\n\
         typedef struct {{\n    float memory[{}][4];\n{travel}    float position;\n}} {stem}_state;\n\n\
         /* Law and effects after dt seconds; 0, and nothing remembered, where an input is not finite or dt is not above 0 and at most 1. */\n",
        model.effects.len()
    )
}

fn preamble(name: &str, title: &str) -> String {
    format!(
        "/* {title}. Made by `trainer export --to c`; do not edit.\n \
         * Every operation is rounded by itself: no -ffast-math, nor what is part of it. */\n\
         #include \"{name}.h\"\n\n#include <float.h>\n#include <stdint.h>\n\n\
         #if defined(__FAST_MATH__) || defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) \\\n    || (FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 16)\n\
         #error \"float operations must be rounded one by one, to float\"\n#endif\n\
         #if defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__ != 0\n\
         #error \"an input that is NaN must be told from a number: compile without -ffinite-math-only\"\n#endif\n\
         #if defined(__GNUC__) && !defined(__clang__)\n#pragma GCC optimize (\"fp-contract=off\")\n\
         #else\n#pragma STDC FP_CONTRACT OFF\n#endif\n\n"
    )
}

/// The header of functions, each behind its comment; `includes` stands in front.
pub(super) fn header(stem: &str, title: &str, includes: &str, prototypes: &[(String, String)]) -> String {
    let guard = format!("{}_H", stem.to_ascii_uppercase());
    let mut text = format!("/* {title}. Made by `trainer export --to c`; do not edit. */\n");
    let _ =
        write!(text, "#ifndef {guard}\n#define {guard}\n\n{includes}#ifdef __cplusplus\nextern \"C\" {{\n#endif\n\n");
    for (comment, prototype) in prototypes {
        let _ = write!(text, "{comment}{prototype};\n\n");
    }
    text + "#ifdef __cplusplus\n}\n#endif\n\n#endif\n"
}
