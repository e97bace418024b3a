//! Networks of tables: from the inputs on in integers, layer by layer.

use core::hint::black_box;

use frikan_shared::model::MAX_INPUTS;
use frikan_shared::network::{Coordinate, Layer, MAX_WIDTH, Network, OneHiddenLayer};
use frikan_shared::pool::Pool;
use frikan_shared::table::{Cell, Table};

use crate::laws::table::{position_geometric, position_uniform};

/// Where a value lies among the cells of its edges.
#[derive(Clone, Copy)]
struct Place {
    row: u32,
    /// The way through the row, `2^32` for the whole of it.
    fraction: u32,
}

/// The row is the high word of the product of position and rows, the way through it the low one.
#[inline(always)]
fn place(position: u32, rows: u32) -> Place {
    let product = u64::from(position) * u64::from(rows);
    Place { row: (product >> 32) as u32, fraction: product as u32 }
}

#[inline(always)]
fn place_input(table: &Table, input: f32) -> Place {
    match table {
        Table::Geometric(layout) => {
            let (position, side) = position_geometric(layout, input);
            place(position, side.cells_per_turn)
        }
        Table::Uniform(layout) => place(position_uniform(layout, input), layout.cells),
    }
}

/// The value of an edge at a fraction of the way through the cell.
#[inline(always)]
fn cubic(cell: &Cell, fraction: u32) -> i32 {
    let x = (fraction >> 1) as Coordinate;
    let [a0, a1, a2, a3] = cell.integers();
    let step = |sum: i32, coefficient: i32| coefficient.wrapping_add(((i64::from(sum) * i64::from(x)) >> 32) as i32);
    step(step(step(a3, a2), a1), a0)
}

/// Evaluates a network on its inputs; 0 where one is NaN.
///
/// The number of instructions depends on the network alone. Meaningless, but some number, where the network does not fit its pool, which
/// no validated network does.
#[must_use]
#[inline(always)]
pub fn evaluate_network<const CELLS: usize>(network: &Network, inputs: &[f32; MAX_INPUTS], pool: &Pool<CELLS>) -> f32 {
    match &network.one_hidden_layer {
        Some(layer) => evaluate_one_hidden_layer(layer, inputs, pool, network.output_step),
        None => evaluate_any_layers(network, inputs, pool),
    }
}

/// The output of a network of one input and one layer of additive nodes: every node goes at once to its edge.
#[inline(never)]
fn evaluate_one_hidden_layer<const CELLS: usize>(
    layer: &OneHiddenLayer,
    &[input, ..]: &[f32; MAX_INPUTS],
    pool: &Pool<CELLS>,
    output_step: f32,
) -> f32 {
    let first = place_input(&layer.source.table, input);
    let row = first.row.wrapping_mul(layer.nodes).wrapping_add(u32::from(layer.source.first_cell));
    let Some([edge, others @ ..]) = pool.run(row, layer.nodes) else { return 0.0 };
    let (mut edge, mut others) = (edge, others.iter());
    let rows_per_turn = layer.rows_per_turn;
    let mut output = 0i32;
    // The last node leaves the loop halfway, where the place of its second cell is known: a compiler that sees a plain loop
    // unrolls it, which takes longer for a handful of nodes, and finds every second cell twice.
    let (cell, fraction) = loop {
        let second = place(cubic(edge, first.fraction) as u32, rows_per_turn);
        let cell = pool.at(second.row);
        let Some(next) = others.next() else { break (cell, second.fraction) };
        // No instruction: keeps the two ends of the loop apart.
        black_box(());
        output = output.wrapping_add(cubic(cell, second.fraction));
        edge = next;
    };
    output = output.wrapping_add(cubic(cell, fraction));
    let output = if input.is_nan() { 0 } else { output };
    output as f32 * output_step
}

/// The output of any network.
#[inline(never)]
fn evaluate_any_layers<const CELLS: usize>(network: &Network, inputs: &[f32; MAX_INPUTS], pool: &Pool<CELLS>) -> f32 {
    let mut sums = [0i32; MAX_WIDTH];
    let mut any_nan = false;
    let targets = network.targets(0);
    for (source, input) in network.sources().iter().zip(inputs) {
        any_nan |= input.is_nan();
        let place = place_input(&source.table, *input);
        add_edges(&mut sums, targets, pool, u32::from(source.first_cell), place);
    }
    for (layer, next) in network.layers().iter().zip(1..) {
        let positions = positions(&sums, *layer);
        let (rows_per_turn, targets) = (layer.rows_per_turn(), network.targets(next));
        sums = [0; MAX_WIDTH];
        for &position in positions.iter().take(layer.nodes()) {
            add_edges(&mut sums, targets, pool, 0, place(position, rows_per_turn));
        }
    }
    let [output, ..] = sums;
    let output = if any_nan { 0 } else { output };
    output as f32 * network.output_step
}

/// Adds the edges of one source to the sums of their targets.
#[inline(always)]
fn add_edges<const CELLS: usize>(
    sums: &mut [i32; MAX_WIDTH],
    targets: usize,
    pool: &Pool<CELLS>,
    first_cell: u32,
    place: Place,
) {
    let row = place.row.wrapping_mul(targets as u32).wrapping_add(first_cell);
    for (sum, target) in sums.iter_mut().take(targets).zip(0u32..) {
        *sum = sum.wrapping_add(cubic(pool.at(row.wrapping_add(target)), place.fraction));
    }
}

/// The positions of the nodes of a layer: its additive sums, then the products of the pairs at their end.
#[inline(always)]
fn positions(sums: &[i32; MAX_WIDTH], layer: Layer) -> [u32; MAX_WIDTH] {
    let mut positions = sums.map(|sum| sum as u32);
    let additive = usize::from(layer.additive);
    let (pairs, _) = sums.get(additive..).unwrap_or_default().as_chunks::<2>();
    let nodes = positions.iter_mut().zip(0..).skip(additive).take(usize::from(layer.products));
    for ((position, node), [first, second]) in nodes.zip(pairs) {
        let middle = layer.start(node).wrapping_add(layer.half_width());
        *position = middle.wrapping_add(((i64::from(*first) * i64::from(*second)) >> 32) as u32);
    }
    positions
}
