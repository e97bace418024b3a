//! Networks of every shape.

use frikan_runtime::shared::model::Law;
use frikan_runtime::shared::network::{Layer, Network, NetworkShape, Source};
use frikan_runtime::shared::table::{Cell, Table, Uniform, UniformShape};

use super::{TestModel, hermite, model};

/// A network `[1,5,1]` whose inner edges are shifted sigmoids.
#[must_use]
pub fn network_1_5_1() -> TestModel {
    network(1, &[(5, 0)])
}

/// A network of two inputs, `[2,[3,1],1]`: three sums and a product.
#[must_use]
pub fn network_two_inputs() -> TestModel {
    network(2, &[(3, 1)])
}

/// A network of three inputs, `[3,3,2,1]`.
#[must_use]
pub fn network_three_inputs() -> TestModel {
    network(3, &[(3, 0), (2, 0)])
}

/// Rows of a test network's inputs and of its nodes.
const INPUT_ROWS: u16 = 8;
const NODE_ROWS: u16 = 4;

/// Steps of a test network's output in one N m.
const OUTPUT_STEPS: f64 = 16_777_216.0;

/// A network of some inputs over hidden layers of sums and products: sigmoids into them, sines out of their nodes, which have
/// `[-1, 1]` for their range.
#[must_use]
pub fn network(inputs: usize, shapes: &[(u8, u8)]) -> TestModel {
    let reaches = &[2.0, 30.0, 60.0][..inputs];
    let layer = |&(additive, products)| Layer { additive, products, rows: NODE_ROWS, first_row: 0 };
    let mut layers: heapless::Vec<Layer, _> = shapes.iter().map(layer).collect();
    // Where the rows of the nodes begin depends on how many there are before them.
    let mut end = usize::from(INPUT_ROWS) * inputs * layers[0].targets();
    for index in 0..layers.len() {
        let columns = layers.get(index + 1).map_or(1, |next| next.targets());
        layers[index].first_row = end.div_ceil(columns) as u16;
        end = (usize::from(layers[index].first_row) + usize::from(NODE_ROWS) * layers[index].nodes()) * columns;
    }
    let mut pool = Vec::new();
    let first = layers[0];
    let sources = reaches.iter().enumerate().map(|(input, reach)| {
        let edges: Vec<_> = (0..first.targets())
            .map(|target| {
                let centre = 0.2 * target as f64 - 0.3 - 0.1 * input as f64;
                into_target(first, target, (input, inputs), move |share: f64| (3.0 * share - centre).tanh())
            })
            .collect();
        let layout = UniformShape { first_cell: 0, cells: INPUT_ROWS, low: -reach, high: *reach };
        let first_cell = pool.len() as u16;
        push_rows(&mut pool, INPUT_ROWS, &edges);
        Source { table: Table::Uniform(Uniform::new(layout)), first_cell }
    });
    let sources = sources.collect();
    for (index, layer) in layers.iter().enumerate() {
        let next = layers.get(index + 1).copied();
        let columns = next.map_or(1, Layer::targets);
        pool.resize(usize::from(layer.first_row) * columns, Cell::ZERO);
        for node in 0..layer.nodes() {
            let sine = move |share: f64| (1.5 * share + 0.3 * node as f64).sin();
            let edges: Vec<Edge> = match next {
                Some(next) => (0..columns).map(|t| into_target(next, t, (node, layer.nodes()), sine)).collect(),
                None => vec![Box::new(move |share| 6.0 * OUTPUT_STEPS * sine(share))],
            };
            push_rows(&mut pool, NODE_ROWS, &edges);
        }
    }
    let shape = NetworkShape { sources, layers, output_step: (1.0 / OUTPUT_STEPS) as f32 };
    model(reaches, Law::Network(Network::new(shape)), &pool)
}

/// A function over `[-1, 1]`, in steps of what it ends in.
type Edge = Box<dyn Fn(f64) -> f64>;

/// `f`, which stays within `[-1, 1]`, as one edge (its number, and of how many) into a sum, with a third of the sum's range to spare.
fn into_target(layer: Layer, target: usize, (edge, edges): (usize, usize), f: impl Fn(f64) -> f64 + 'static) -> Edge {
    let share = 1.0 / (1.5 * edges as f64);
    let half_width = f64::from(layer.half_width());
    if target < usize::from(layer.additive) {
        // The middle of the node's rows is in equal parts in its edges, their start in the first one.
        let start = if edge == 0 { f64::from(layer.start(target)) } else { 0.0 };
        Box::new(move |x| start + (share * f(x) + 1.0 / edges as f64) * half_width)
    } else {
        let largest = (half_width * 4_294_967_296.0).sqrt();
        Box::new(move |x| share * f(x) * largest)
    }
}

/// Adds `rows` rows of equal width of the edges.
fn push_rows(pool: &mut Vec<Cell>, rows: u16, edges: &[Edge]) {
    let width = 2.0 / f64::from(rows);
    for row in 0..rows {
        let start = width * f64::from(row) - 1.0;
        pool.extend(edges.iter().map(|edge| {
            let [c0, c1, c2, c3] = hermite(edge, start, start + width);
            Cell::from_integers([c0, 2.0 * c1, 4.0 * c2, 8.0 * c3].map(|coefficient| coefficient.round() as i64 as i32))
        }));
    }
}
