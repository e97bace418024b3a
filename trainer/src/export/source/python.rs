//! Python without a library, in double precision: what the drive computes, but for its rounding; a network, which is integers, with the bits of the drive.

use std::fmt::Write;

use frikan_shared::image::Image;
use frikan_shared::model::Model;

use super::language::Language;
use super::law::{law, no_law, parameters, step, unusable};
use super::library;
use super::lookup::cells;
use crate::error::Result;
use crate::fit::CELLS;

/// A module that evaluates an image: the static law as the function `friction`, and, where there are effects, law and effects as
/// `Friction.step`, of numbers.
///
/// # Errors
/// `FRK-U005` for an integer table, which has a form in C.
pub fn module(title: &str, image: &Image<CELLS>) -> Result<String> {
    let model = &image.model;
    let names = parameters(model).join(", ");
    let statements = indented(&law(Language::Python, model)?, "    ");
    let stepping = if model.effects.is_empty() { String::new() } else { stepping(model, &names) };
    let cells = cells(Language::Python, model, &format!("{statements}{stepping}"));
    let library = library::PYTHON;
    let mut text = format!("# {title}. Made by `trainer export --to python`; do not edit.\n\n{library}{cells}");
    let (unit, limit, no_law) = (model.output_unit.symbol(), model.output_limit, no_law(model));
    let _ = write!(
        text,
        "\n\ndef friction({names}):\n    \"\"\"The static law in {unit}, at most {limit:?}; 0 where {no_law}.\n"
    );
    for (input, name) in model.inputs.iter().zip(parameters(model)) {
        let (low, high, unit) = (input.low, input.high, input.unit.symbol());
        let _ = write!(text, "\n    {name}: {low:?} to {high:?} {unit}, held at the nearer end outside.");
    }
    let _ = write!(text, "\n    \"\"\"\n{statements}{stepping}");
    Ok(text)
}

fn indented(statements: &[String], by: &str) -> String {
    statements.iter().map(|statement| format!("{by}{statement}\n")).collect()
}

/// State and step of a model with effects.
fn stepping(model: &Model<CELLS>, names: &str) -> String {
    let mut body = vec![
        "self.position = place = 0.0".to_owned(),
        Language::Python.return_where(&unusable(Language::Python, model), 0.0),
        "m = Motion()".to_owned(),
    ];
    body.extend(step(Language::Python, model, "friction"));
    body.push("self.position = place".to_owned());
    body.push(format!("return limited(torque, {})", Language::Python.number(model.output_limit)));
    let body = indented(&body, "        ");
    format!(
        "\n\nclass Friction:\n    \"\"\"What the effects remember; `position` is what the last step adds to the link's position.\"\"\"\n\n    \
         def __init__(self):\n        self.memory = [[0.0] * 4 for _ in range({})]\n        self.travel = [0.0] * 4\n        \
         self.position = 0.0\n\n    def step(self, dt, {names}):\n        \
         \"\"\"Law and effects after dt seconds; 0, and nothing remembered, where an input is not finite or dt is not above 0 and at most 1.\"\"\"\n{body}",
        model.effects.len()
    )
}
