//! A network of tables as statements: from the inputs on in integers, with the very bits of the drive in every language.

use frikan_shared::model::Model;
use frikan_shared::network::{Layer, Network};
use frikan_shared::table::Table;

use super::language::Language;
use crate::fit::CELLS;

/// Statements that end in the friction; `names` are the inputs, and the cells of the model stand before the function as [`edges`].
pub(super) fn statements(language: Language, network: &Network, names: &[String]) -> Vec<String> {
    let mut statements = vec![sums(language, 0, network.targets(0))];
    for (source, name) in network.sources().iter().zip(names) {
        let spot = match &source.table {
            Table::Geometric(layout) => {
                let sides = layout.sides.map(|side| [side.origin, side.last_position, side.cells_per_turn, side.sign]);
                let (offset, sides) = (language.number(layout.offset), language.fours_of_words(&sides));
                format!("spot_geometric({name}, {offset}, {sides})")
            }
            Table::Uniform(layout) => {
                let [low, scale] = [layout.low, layout.scale].map(|number| language.number(number));
                format!("spot_uniform({name}, {low}, {scale}, {})", language.unsigned(layout.cells))
            }
        };
        statements.push(edges_added(language, 0, network.targets(0), source.first_cell, &spot));
    }
    for (index, layer) in network.layers().iter().enumerate() {
        let targets = network.targets(index + 1);
        statements.push(sums(language, index + 1, targets));
        for node in 0..layer.nodes() {
            let (position, rows) = (position(language, index, *layer, node), language.unsigned(layer.rows_per_turn()));
            let spot = format!("spot_of({position}, {rows})");
            statements.push(edges_added(language, index + 1, targets, 0, &spot));
        }
    }
    let output = signed(language, &format!("sums_{}[0]", network.layers().len()));
    let step = language.number(network.output_step);
    statements.push(language.last(&match language {
        Language::C => format!("(float){output} * {step}"),
        Language::Rust => format!("{output} as f32 * {step}"),
        Language::Python => format!("single(single({output}) * {step})"),
    }));
    statements
}

/// The sums in which the edges of a layer end.
fn sums(language: Language, layer: usize, targets: usize) -> String {
    match language {
        Language::C => format!("uint32_t sums_{layer}[{targets}] = {{0}};"),
        Language::Rust => format!("let mut sums_{layer} = [0_u32; {targets}];"),
        Language::Python => format!("sums_{layer} = [0] * {targets}"),
    }
}

/// Adds the edges that leave a spot.
fn edges_added(language: Language, layer: usize, targets: usize, first: u16, spot: &str) -> String {
    match language {
        Language::C => format!("add_edges(sums_{layer}, {targets}u, edges + {first}, {spot});"),
        Language::Rust => format!("add_edges(&mut sums_{layer}, {spot}, {first}, &EDGES);"),
        Language::Python => format!("add_edges(sums_{layer}, {spot}, {first}, EDGES)"),
    }
}

/// Where the value of a node lies among its rows.
fn position(language: Language, layer: usize, shape: Layer, node: usize) -> String {
    let additive = usize::from(shape.additive);
    if node < additive {
        return format!("sums_{layer}[{node}]");
    }
    let first = additive + 2 * (node - additive);
    let [first, second] = [first, first + 1].map(|sum| signed(language, &format!("sums_{layer}[{sum}]")));
    let product = format!("high({first}, {second})");
    let middle = language.unsigned(shape.start(node).wrapping_add(shape.half_width()));
    match language {
        Language::C => format!("{middle} + (uint32_t){product}"),
        Language::Rust => format!("{middle}.wrapping_add({product} as u32)"),
        Language::Python => format!("({middle} + {product}) % 2**32"),
    }
}

/// A word as a number with a sign.
fn signed(language: Language, word: &str) -> String {
    match language {
        Language::C => format!("(int32_t){word}"),
        Language::Rust => format!("{word} as i32"),
        Language::Python => format!("signed({word})"),
    }
}

/// The cells of a model as integers.
pub(super) fn edges(language: Language, model: &Model<CELLS>) -> String {
    let integer = |integer: i32| match language {
        // The constant without its sign is none of this type.
        Language::C if integer == i32::MIN => "-2147483647 - 1".to_owned(),
        _ => integer.to_string(),
    };
    let rows: Vec<String> = model.cells.iter().map(|cell| language.inner(&cell.integers().map(integer))).collect();
    language.fours("edges", ["int32_t", "i32"], &rows)
}
