//! The value of a table, as a call of the library beside the source.

use frikan_shared::model::{Law, Model};
use frikan_shared::table::Table;

use super::language::Language;
use super::network;
use crate::fit::CELLS;

/// The cells of a model as those read them that `functions` call: as integers the law that is a network, as floats every table.
pub(super) fn cells(language: Language, model: &Model<CELLS>, functions: &str) -> String {
    let edges = if matches!(model.law, Law::Network(_)) { network::edges(language, model) } else { String::new() };
    if !functions.contains(&format!("({}, ", language.cells())) {
        return edges;
    }
    // What is no number is an edge of a network, and read by no table.
    let number = |value: f32| language.number(if value.is_finite() { value } else { 0.0 });
    let rows: Vec<String> = model.cells.iter().map(|cell| language.inner(&cell.floats().map(number))).collect();
    edges + &language.fours("cells", ["float", "f32"], &rows)
}

/// The value of a table at `x`.
pub(super) fn lookup(language: Language, table: &Table, x: &str) -> String {
    let cells = language.cells();
    match table {
        Table::Geometric(layout) => {
            let sides = layout.sides.map(|side| [side.origin, side.last_position, side.cells_per_turn, side.sign]);
            let offset = language.number(layout.offset);
            format!("geometric({cells}, {x}, {offset}, {})", language.fours_of_words(&sides))
        }
        Table::Uniform(layout) => {
            let (low, scale) = (language.number(layout.low), language.number(layout.scale));
            format!("uniform({cells}, {x}, {low}, {scale}, {})", language.words(&[layout.first_cell, layout.cells]))
        }
    }
}
