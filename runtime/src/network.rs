//! Networks of tables, layer by layer.

use frikan_shared::elementary;
use frikan_shared::model::MAX_INPUTS;
use frikan_shared::network::{MAX_WIDTH, Network, Outer};
use frikan_shared::pool::Pool;

use crate::table::{cubic, place};

/// Evaluates a network whose first layer reads the first `input_count` inputs. Edges add up in the order of their sources; products are taken pair by pair.
///
/// The number of instructions depends on the network alone. Zero where it does not fit its pool, which no validated
/// network does.
#[must_use]
pub fn evaluate_network<const CELLS: usize>(
    network: &Network,
    pool: &Pool<CELLS>,
    inputs: &[f32; MAX_INPUTS],
    input_count: usize,
) -> f32 {
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
            let row = u32::from(source.first_cell).wrapping_add(place.row.wrapping_mul(targets as u32));
            for (sum, column) in sums.iter_mut().take(targets).zip(0u32..) {
                *sum += cubic(pool.at(row.wrapping_add(column)), place);
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
