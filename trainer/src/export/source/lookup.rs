//! The value of a table, as a call of the library beside the source.

use frikan_shared::table::Table;

use super::language::Language;

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
