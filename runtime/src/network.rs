//! Networks of tables, layer by layer.

use frikan_shared::elementary;
use frikan_shared::model::MAX_INPUTS;
use frikan_shared::network::{MAX_WIDTH, Network, Outer};
use frikan_shared::table::Cell;

use crate::table::{cubic, place};

/// Evaluates a network whose first layer reads the first `input_count` inputs. Edges add up in the order of their sources; products are taken pair by pair.
///
/// The number of instructions depends on the network alone. Zero where it does not fit its pool, which no validated
/// network does.
#[must_use]
pub fn evaluate_network(network: &Network, cells: &[Cell], inputs: &[f32; MAX_INPUTS], input_count: usize) -> f32 {
    let mut nodes = [0.0f32; MAX_WIDTH];
    for (node, input) in nodes.iter_mut().zip(inputs) {
        *node = *input;
    }
    let mut width = input_count;
    let mut sources = network.sources.iter();
    for layer in &network.layers {
        let targets = layer.targets();
        let mut sums = [0.0f32; MAX_WIDTH];
        for (&node, source) in nodes.iter().take(width).zip(&mut sources) {
            let place = place(&source.table, node);
            let row = usize::from(source.first_cell) + place.row as usize * targets;
            for (sum, cell) in sums.iter_mut().zip(cells.get(row..row + targets).unwrap_or_default()) {
                *sum += cubic(cell, place);
            }
        }
        width = layer.outputs();
        nodes = sums;
        let additive = usize::from(layer.additive);
        let (factors, _) = sums.get(additive..).unwrap_or_default().as_chunks::<2>();
        let products = nodes.iter_mut().skip(additive).take(usize::from(layer.products));
        for (node, [first, second]) in products.zip(factors) {
            *node = first * second;
        }
    }
    let [sum, ..] = nodes;
    match network.outer {
        Outer::Linear => sum,
        Outer::Tanh { scale, offset } => offset + scale * elementary::tanh(sum),
    }
}
