//! A network of tables as statements of C: from the inputs on in integers, with the very bits of the drive.

use frikan_shared::model::Model;
use frikan_shared::network::{Layer, Network};
use frikan_shared::table::Table;

use super::language::Language;
use crate::fit::CELLS;

/// Statements that end in the friction; `names` are the inputs, and the cells of the model stand before the function as [`edges`].
pub(super) fn statements(network: &Network, names: &[String]) -> Vec<String> {
    let mut statements = vec![sums(0, network.targets(0))];
    for (source, name) in network.sources().iter().zip(names) {
        let spot = match &source.table {
            Table::Geometric(layout) => {
                let sides = layout.sides.map(|side| [side.origin, side.last_position, side.cells_per_turn, side.sign]);
                let (offset, sides) = (Language::C.number(layout.offset), Language::C.fours_of_words(&sides));
                format!("spot_geometric({name}, {offset}, {sides})")
            }
            Table::Uniform(layout) => {
                let [low, scale] = [layout.low, layout.scale].map(|number| Language::C.number(number));
                format!("spot_uniform({name}, {low}, {scale}, {}u)", layout.cells)
            }
        };
        statements.push(edges_added(0, network.targets(0), source.first_cell, &spot));
    }
    for (index, layer) in network.layers().iter().enumerate() {
        let targets = network.targets(index + 1);
        statements.push(sums(index + 1, targets));
        for node in 0..layer.nodes() {
            let spot = format!("spot_of({}, {}u)", position(index, *layer, node), layer.rows_per_turn());
            statements.push(edges_added(index + 1, targets, 0, &spot));
        }
    }
    let last = network.layers().len();
    statements.push(format!("return (float)(int32_t)sums_{last}[0] * {};", Language::C.number(network.output_step)));
    statements
}

/// The sums in which the edges of a layer end.
fn sums(layer: usize, targets: usize) -> String {
    format!("uint32_t sums_{layer}[{targets}] = {{0}};")
}

/// Adds the edges that leave a spot.
fn edges_added(layer: usize, targets: usize, first: u16, spot: &str) -> String {
    format!("add_edges(sums_{layer}, {targets}u, edges + {first}, {spot});")
}

/// Where the value of a node lies among its rows.
fn position(layer: usize, shape: Layer, node: usize) -> String {
    let additive = usize::from(shape.additive);
    if node < additive {
        return format!("sums_{layer}[{node}]");
    }
    let first = additive + 2 * (node - additive);
    let middle = shape.start(node).wrapping_add(shape.half_width());
    format!("{middle}u + (uint32_t)high((int32_t)sums_{layer}[{first}], (int32_t)sums_{layer}[{}])", first + 1)
}

/// The cells of a model as integers.
pub(super) fn edges(model: &Model<CELLS>) -> String {
    let row = |cell: &frikan_shared::table::Cell| {
        let [a, b, c, d] = cell.integers();
        format!("    {{{a}, {b}, {c}, {d}}},\n").replace("-2147483648", "-2147483647 - 1")
    };
    let rows: String = model.cells.iter().map(row).collect();
    format!("static const int32_t edges[{}][4] = {{\n{rows}}};\n\n", model.cells.len())
}
