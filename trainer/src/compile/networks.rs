//! Edges of a network as cubics in integers: their rows, the range of the sums in which they end, the steps of these, and the whole as
//! a network with its cells.

use frikan_shared::network::{Layer, Network, NetworkShape, Source};
use frikan_shared::table::{Cell, Table};

use super::cells::{Cubic, bound_cell, fit_cell};
use super::formula::Curve;

/// Steps of a sum that is no position, on either side of zero.
const SUM: f64 = 2_147_483_648.0;

/// Rows before which those of a network must end; each then has `2^21` positions at least.
const MOST_ROWS: usize = 2048;

/// Error of a node's coordinate in its row: its position is a whole number, and the edges into it are off by 16 of them at most.
pub const COORDINATE_ERROR: f64 = 16.0 / 2_097_152.0;

/// Share of a sum's positions that its range leaves unused, for roundings.
const SPARE: f64 = 1.0e-3;

/// An edge: a cubic for each row, in the unit of the sum in which it ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// Cubics in the local coordinate of their rows.
    pub cubics: Vec<Cubic>,
    /// Certified error, apart from the rounding to steps.
    pub error: f64,
}

impl Edge {
    /// The edge `curve` over rows, whose local coordinate is found to within `coordinate_error`; without a curve, nothing.
    #[must_use]
    pub fn new(curve: Option<&dyn Curve>, rows: &[(f64, f64)], coordinate_error: f64) -> Self {
        let Some(curve) = curve else { return Self { cubics: vec![[0.0; 4]; rows.len()], error: 0.0 } };
        let cubics: Vec<Cubic> = rows.iter().map(|&(near, far)| fit_cell(curve, near, far)).collect();
        let error = rows.iter().zip(&cubics).fold(0.0f64, |worst, (&(near, far), cubic)| {
            let (approximation, moved) = bound_cell(curve, near, far, cubic, coordinate_error);
            worst.max(approximation + moved)
        });
        Self { cubics, error }
    }

    /// Least and largest Bernstein coefficient of all rows.
    fn range(&self) -> (f64, f64) {
        let bernstein = |&[c0, c1, c2, c3]: &Cubic| [c0, c0 + c1 / 3.0, c0 + (2.0 * c1 + c2) / 3.0, c0 + c1 + c2 + c3];
        self.cubics
            .iter()
            .flat_map(bernstein)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), b| (low.min(b), high.max(b)))
    }

    /// The largest partial sum of the evaluation but the last.
    fn inner(&self) -> f64 {
        let partial = |&[_, c1, c2, c3]: &Cubic| {
            let second = 4.0 * c2.abs() + 4.0 * c3.abs();
            second.max(2.0 * c1.abs() + 0.5 * second)
        };
        self.cubics.iter().map(partial).fold(0.0, f64::max)
    }
}

/// The nodes of a hidden layer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Nodes {
    /// Additive nodes.
    pub additive: u8,
    /// Multiplicative nodes of two factors.
    pub products: u8,
}

/// Edges between two layers: for each node or input on the near side, one edge to each sum on the far side.
pub type Edges = Vec<Vec<Edge>>;

/// The edges into one sum.
fn into_sum(edges: &Edges, target: usize) -> impl Iterator<Item = &Edge> + Clone {
    edges.iter().map(move |edges| &edges[target])
}

/// `width`, or what the partial sums of the edges need where that is more, and something to spare.
fn widened<'a>(edges: impl Iterator<Item = &'a Edge> + Clone, width: f64) -> f64 {
    let constant = edges.clone().map(|edge| edge.range().1.abs()).fold(1.0e-9, f64::max);
    edges.map(Edge::inner).fold(width.max(1.0e-6 * constant), f64::max) * (1.0 + SPARE)
}

/// The range of values of a sum that is an additive node.
fn additive_range(edges: &Edges, target: usize) -> [f64; 2] {
    let ends = into_sum(edges, target).map(Edge::range).fold((0.0, 0.0), |sum, end| (sum.0 + end.0, sum.1 + end.1));
    let width = widened(into_sum(edges, target), ends.1 - ends.0);
    let low = ends.0 - 0.5 * SPARE * width / (1.0 + SPARE);
    [low, low + width]
}

/// The largest magnitude of a sum of either sign.
fn largest(edges: &Edges, target: usize) -> f64 {
    let sum = into_sum(edges, target).map(Edge::range).map(|(low, high)| low.abs().max(high.abs())).sum();
    widened(into_sum(edges, target), sum)
}

/// The ranges of values of the nodes at the end of edges, over which the edges that leave them have their rows.
#[must_use]
pub fn node_ranges(edges: &Edges, nodes: Nodes) -> Vec<[f64; 2]> {
    let additive = usize::from(nodes.additive);
    let products = (0..usize::from(nodes.products)).map(|pair| {
        let most = largest(edges, additive + 2 * pair) * largest(edges, additive + 2 * pair + 1);
        [-most, most]
    });
    (0..additive).map(|target| additive_range(edges, target)).chain(products).collect()
}

/// The steps of a sum: a value is `low` and `step` for each step from `start`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Scale {
    low: f64,
    step: f64,
    start: f64,
}

/// The steps of the sums at the end of edges: positions of a hidden layer and its factors, or the output.
fn scales(edges: &Edges, into: Option<&Layer>) -> Vec<Scale> {
    let signed = |target: usize, reach: f64| Scale { low: 0.0, step: largest(edges, target) / reach, start: 0.0 };
    let Some(layer) = into else {
        // The image keeps the step as a float.
        let output = signed(0, SUM);
        return vec![Scale { step: f64::from(output.step as f32), ..output }];
    };
    let half_width = f64::from(layer.half_width());
    let scale = |target: usize| {
        if target < usize::from(layer.additive) {
            let [low, high] = additive_range(edges, target);
            Scale { low, step: (high - low) / (2.0 * half_width), start: f64::from(layer.start(target)) }
        } else {
            // The product of two factors is taken in units of 2^32.
            signed(target, (half_width * 2.0 * SUM).sqrt())
        }
    };
    (0..layer.targets()).map(scale).collect()
}

/// The cells of edges: source by source, row by row, sum by sum.
fn cells(edges: &Edges, scales: &[Scale]) -> Vec<Cell> {
    // Every edge counts from its least value; the first of a sum makes up for the others.
    let zero = |source: usize, target: usize| {
        let others = || into_sum(edges, target).skip(1).map(|edge| edge.range().0).sum::<f64>();
        if source == 0 { scales[target].low - others() } else { edges[source][target].range().0 }
    };
    // Positions are taken modulo 2^32.
    let whole = |steps: f64| steps.round() as i64 as i32;
    let mut cells = Vec::new();
    for (source, edges) in edges.iter().enumerate() {
        let zeros: Vec<f64> = (0..edges.len()).map(|target| zero(source, target)).collect();
        for row in 0..edges.first().map_or(0, |edge| edge.cubics.len()) {
            for ((edge, scale), zero) in edges.iter().zip(scales).zip(&zeros) {
                let [c0, c1, c2, c3] = edge.cubics[row];
                let start = if source == 0 { scale.start } else { 0.0 };
                let steps = [c0 - zero, 2.0 * c1, 4.0 * c2, 8.0 * c3].map(|c| c / scale.step);
                cells.push(Cell::from_integers([start + steps[0], steps[1], steps[2], steps[3]].map(whole)));
            }
        }
    }
    cells
}

/// The network of inputs in the layouts `tables`, with `edges` from layer to layer and `nodes` in the hidden ones, and its cells. `None`
/// where it is too large for an image.
#[must_use]
pub fn assemble(tables: &[Table], edges: &[Edges], nodes: &[Nodes]) -> Option<(Network, Vec<Cell>)> {
    let (first, later) = edges.split_first()?;
    let mut sources = heapless::Vec::new();
    let mut layers = heapless::Vec::new();
    let mut end = 0;
    for (table, edges) in tables.iter().zip(first) {
        sources.push(Source { table: *table, first_cell: u16::try_from(end).ok()? }).ok()?;
        end += edges.iter().map(|edge| edge.cubics.len()).sum::<usize>();
    }
    for (edges, &Nodes { additive, products }) in later.iter().zip(nodes) {
        let node = edges.first()?;
        let (rows, first_row) = (node.first()?.cubics.len(), end.div_ceil(node.len()));
        let end_row = first_row + rows * edges.len();
        if end_row >= MOST_ROWS {
            return None;
        }
        end = end_row * node.len();
        let (rows, first_row) = (u16::try_from(rows).ok()?, u16::try_from(first_row).ok()?);
        layers.push(Layer { additive, products, rows, first_row }).ok()?;
    }
    let mut pool = Vec::new();
    let mut output_step = 1.0;
    for (index, edges) in edges.iter().enumerate() {
        // Rows are counted from the start of the pool.
        let columns = edges.first()?.len();
        pool.resize(if index == 0 { 0 } else { pool.len().next_multiple_of(columns) }, Cell::ZERO);
        let scales = scales(edges, layers.get(index));
        pool.extend(cells(edges, &scales));
        output_step = scales.first()?.step;
    }
    Some((Network::new(NetworkShape { sources, layers, output_step: output_step as f32 }), pool))
}
