//! Rust: one module for `no_std`, with the bits of the drive.

use std::fmt::Write;

use frikan_shared::image::Image;
use frikan_shared::model::Model;

use super::language::Language;
use super::law::{law, no_law, parameters, reads_position, step, unusable};
use super::library;
use super::lookup::cells;
use crate::error::Result;
use crate::fit::CELLS;

/// A module that evaluates an image: the static law as the function `friction`, and, where there are effects, law and effects as
/// `Friction::step`. It needs nothing but `core`.
///
/// # Errors
/// `FRK-U005` for an integer table, which has a form in C.
pub fn module(title: &str, image: &Image<CELLS>) -> Result<String> {
    let model = &image.model;
    let names: Vec<String> = parameters(model).into_iter().map(|name| format!("{name}: f32")).collect();
    let names = names.join(", ");
    let statements = indented(&law(Language::Rust, model)?, "    ");
    let mut functions = format!("{}pub fn friction({names}) -> f32 {{\n{statements}}}\n", what_friction_is(model));
    if !model.effects.is_empty() {
        functions += &stepping(model, &names);
    }
    let cells = cells(Language::Rust, model, &functions);
    let library = library::needed(Language::Rust, &functions);
    let head = format!("// {title}. Made by `trainer export --to rust`; do not edit.\n\n");
    Ok(format!("{head}{library}{cells}{functions}"))
}

fn indented(statements: &[String], by: &str) -> String {
    statements.iter().map(|statement| format!("{by}{statement}\n")).collect()
}

fn what_friction_is(model: &Model<CELLS>) -> String {
    let unit = model.output_unit.symbol();
    let mut text =
        format!("/// The static law in {unit}, at most {:?}; 0 where {}.\n///\n", model.output_limit, no_law(model));
    for (input, name) in model.inputs.iter().zip(parameters(model)) {
        let (low, high, unit) = (input.low, input.high, input.unit.symbol());
        let _ = writeln!(text, "/// * `{name}`: {low:?} to {high:?} {unit}, held at the nearer end outside");
    }
    text
}

/// State and step of a model with effects.
fn stepping(model: &Model<CELLS>, names: &str) -> String {
    let count = model.effects.len();
    let (travel, no_travel) =
        if reads_position(model) { ("    travel: [f32; 4],\n", ", travel: [0.0; 4]") } else { ("", "") };
    let place = if super::moves_link(model) { "let (mut torque, mut place);" } else { "let mut torque;" };
    let mut body = vec![
        "self.position = 0.0;".to_owned(),
        Language::Rust.return_where(&unusable(Language::Rust, model), 0.0),
        "let mut m = Motion::default();".to_owned(),
        place.to_owned(),
    ];
    if super::moves_link(model) {
        body.push("place = 0.0;".to_owned());
    }
    body.extend(step(Language::Rust, model, "friction"));
    if super::moves_link(model) {
        body.push("self.position = place;".to_owned());
    }
    body.push(format!("limited(torque, {})", Language::Rust.number(model.output_limit)));
    let body = indented(&body, "        ");
    format!(
        "\n/// What the effects remember.\n#[derive(Clone, Copy, Debug, PartialEq)]\npub struct Friction {{\n    \
         memory: [[f32; 4]; {count}],\n{travel}    /// What the last step adds to the link's position.\n    pub position: f32,\n}}\n\n\
         impl Friction {{\n    /// At rest, cold, nothing wound up.\n    pub const fn new() -> Self {{\n        \
         Self {{ memory: [[0.0; 4]; {count}]{no_travel}, position: 0.0 }}\n    }}\n\n    \
         /// Law and effects after `dt` seconds; 0, and nothing remembered, where an input is not finite or `dt` is not above 0 and at most 1.\n    \
         pub fn step(&mut self, dt: f32, {names}) -> f32 {{\n{body}    }}\n}}\n"
    )
}
