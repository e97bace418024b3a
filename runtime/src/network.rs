//! Networks of tables: from the inputs on in integers, layer by layer.

use frikan_shared::model::{MAX_INPUTS, Model};
use frikan_shared::network::{Coordinate, Layer, MAX_WIDTH, MIDDLE, Network, Source};
use frikan_shared::pool::Pool;
use frikan_shared::table::{Cell, Table};

use crate::table::{position_geometric, position_uniform};

/// Where a value lies among the cells of its edges.
#[derive(Clone, Copy)]
struct Place {
    row: u32,
    x: Coordinate,
}

/// The row is the high word of the product of position and rows, the way through it the low one.
#[inline(always)]
fn place(position: u32, rows: u32) -> Place {
    let product = u64::from(position) * u64::from(rows);
    Place { row: (product >> 32) as u32, x: (product as u32 >> 1) as Coordinate }
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

/// The value of an edge.
#[inline(always)]
fn cubic(cell: &Cell, x: Coordinate) -> i32 {
    let [a0, a1, a2, a3] = cell.integers();
    let step = |sum: i32, coefficient: i32| coefficient.wrapping_add(((i64::from(sum) * i64::from(x)) >> 32) as i32);
    step(step(step(a3, a2), a1), a0)
}

/// Evaluates the law `network` of `model` on its inputs; 0 where one is NaN.
///
/// The number of instructions depends on the network alone, once the inputs are placed. Meaningless, but some number, where the network does
/// not fit its pool, which no validated network does.
#[must_use]
#[inline(never)]
pub fn evaluate_network<const CELLS: usize>(
    model: &Model<CELLS>,
    network: &Network,
    inputs: &[f32; MAX_INPUTS],
) -> f32 {
    let output = match (network.sources.as_slice(), network.layers.as_slice()) {
        ([source], [layer]) if layer.products == 0 => one_hidden_layer(source, *layer, &model.cells, inputs),
        _ => any_layers(network, &model.cells, inputs),
    };
    output as f32 * network.output_step
}

/// The last sum of a network of one input and one layer of additive nodes: every node goes at once to its edge.
#[inline(always)]
fn one_hidden_layer<const CELLS: usize>(
    source: &Source,
    layer: Layer,
    pool: &Pool<CELLS>,
    &[input, ..]: &[f32; MAX_INPUTS],
) -> i32 {
    let first = place_input(&source.table, input);
    let width = u32::from(layer.additive);
    let row = first.row.wrapping_mul(width).wrapping_add(u32::from(source.first_cell));
    let rows_doubled = 2 * u32::from(layer.rows);
    let mut node_doubled = 2 * u32::from(layer.first_cell);
    let mut output = 0i32;
    for target in 0..width {
        let sum = cubic(pool.at(row.wrapping_add(target)), first.x);
        let second = place(sum as u32, rows_doubled);
        // Not `at`: with a way out, the compiler leaves this loop as it is; unrolled, it takes longer for a handful of nodes.
        let Some(cell) = pool.within(second.row.wrapping_add(node_doubled >> 1)) else { break };
        output = output.wrapping_add(cubic(cell, second.x));
        node_doubled = node_doubled.wrapping_add(rows_doubled);
    }
    if input.is_nan() { 0 } else { output }
}

/// The last sum of any network.
#[inline(never)]
fn any_layers<const CELLS: usize>(network: &Network, pool: &Pool<CELLS>, inputs: &[f32; MAX_INPUTS]) -> i32 {
    let targets = |layer: usize| network.layers.get(layer).map_or(1, |layer| layer.targets());
    let mut sums = [0i32; MAX_WIDTH];
    for (source, input) in network.sources.iter().zip(inputs) {
        add_edges(&mut sums, targets(0), pool, u32::from(source.first_cell), place_input(&source.table, *input));
    }
    for (layer, next) in network.layers.iter().zip(1..) {
        let values = values(&sums, *layer);
        let (rows, columns) = (u32::from(layer.rows), targets(next));
        let mut first_cell = u32::from(layer.first_cell);
        sums = [0; MAX_WIDTH];
        for &value in values.iter().take(layer.nodes()) {
            add_edges(&mut sums, columns, pool, first_cell, place(value as u32, 2 * rows));
            first_cell = first_cell.wrapping_add(rows.wrapping_mul(columns as u32));
        }
    }
    let any_nan = inputs.iter().zip(&network.sources).fold(false, |any, (input, _)| any | input.is_nan());
    let [output, ..] = sums;
    if any_nan { 0 } else { output }
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
        *sum = sum.wrapping_add(cubic(pool.at(row.wrapping_add(target)), place.x));
    }
}

/// The nodes of a layer: its additive sums, then the products of the pairs at their end.
#[inline(always)]
fn values(sums: &[i32; MAX_WIDTH], layer: Layer) -> [i32; MAX_WIDTH] {
    let mut values = *sums;
    let additive = usize::from(layer.additive);
    let (pairs, _) = sums.get(additive..).unwrap_or_default().as_chunks::<2>();
    for (value, [first, second]) in values.iter_mut().skip(additive).take(usize::from(layer.products)).zip(pairs) {
        *value = MIDDLE.wrapping_add(((i64::from(*first) * i64::from(*second)) >> 32) as i32);
    }
    values
}
