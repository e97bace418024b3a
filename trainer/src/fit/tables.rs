//! A trained network as the tables of a drive: one certified table for one input, a network of tables for several.

use frikan_shared::model::Law;
use frikan_shared::network::{Layer, MAX_SOURCES, MAX_WIDTH, Network as TableNetwork, Outer, Source};
use frikan_shared::table::{Cell, Geometric, GeometricShape, Symmetry, Table, Uniform, UniformShape};

use super::piecewise::{NetworkCurve, Piecewise};
use crate::compile::tables::{compile_layout, compile_table};
use crate::kan::{GraphSummary, Network};

/// A law as tables.
#[derive(Clone, Debug)]
pub(super) struct Tables {
    pub(super) law: Law,
    pub(super) cells: Vec<Cell>,
    /// Positions of the inputs that the law reads, in its order.
    pub(super) inputs: Vec<usize>,
}

/// How often the bound of a single node is doubled where no layout meets it: bounds for the worst case are strict.
const RELAXATIONS: i32 = 8;

/// Compiles `network` to within `bound` (unit of the output; for several inputs in the worst case, which is far from the
/// usual one). `ranges` are those of all its inputs. `None` when it does not fit a drive's tables.
pub(super) fn compile(network: &Network, graph: &GraphSummary, ranges: &[[f64; 2]], bound: f64) -> Option<Tables> {
    let live: Vec<usize> = (0..ranges.len()).filter(|&input| network.live_nodes()[0][input]).collect();
    match live[..] {
        [] => None,
        [only] => single(network, only, ranges[only], bound),
        _ => several(network, graph, &live, bound),
    }
}

fn single(network: &Network, input: usize, [low, high]: [f64; 2], bound: f64) -> Option<Tables> {
    let curve = NetworkCurve::of(network);
    let compiled = compile_table(&curve, low, high, bound, 0).ok()?;
    Some(Tables { law: compiled.table.into(), cells: compiled.cells, inputs: vec![input] })
}

/// A node with outgoing activations, before its layout is chosen.
struct Node {
    /// Range of its value.
    domain: [f64; 2],
    /// One activation for each target of the next layer, `None` where pruned.
    edges: Vec<Option<Piecewise>>,
    /// Error that each activation may have.
    bounds: Vec<f64>,
}

fn several(network: &Network, graph: &GraphSummary, live: &[usize], bound: f64) -> Option<Tables> {
    let curve = NetworkCurve::of(network);
    let alive = network.live_nodes();
    let depth = network.layers().len();
    let active = graph.edges.iter().filter(|edge| edge.active).count().max(1) as f64;
    let mut layers = heapless::Vec::new();
    let mut nodes = Vec::new();
    for (index, layer) in network.layers().iter().enumerate() {
        let kept: Vec<usize> = (0..layer.nodes.count()).filter(|&node| alive[index + 1][node]).collect();
        let terminals: Vec<usize> = kept.iter().flat_map(|&node| layer.terminals_of(node)).collect();
        let additive = kept.iter().filter(|&&node| node < layer.nodes.sums).count();
        let shape = Layer { additive: additive as u8, products: (kept.len() - additive) as u8 };
        layers.push(shape).ok()?;
        let mut first_active = index + 1 == depth;
        for from in (0..layer.inputs).filter(|&from| alive[index][from]) {
            let mut edges: Vec<Option<Piecewise>> =
                terminals.iter().map(|&to| curve.edges[index][to][from].clone()).collect();
            // The output's centre goes into the first activation of the last layer.
            if first_active && let Some(edge) = edges.iter_mut().flatten().next() {
                *edge = edge.clone().raised(network.output.centre);
                first_active = false;
            }
            let domain = graph.edges.iter().find(|e| e.layer == index && e.from == from)?.domain;
            let bounds = terminals
                .iter()
                .map(|&to| bound / (active * sensitivity(graph, &curve, index + 1, layer_node(layer, to))))
                .collect();
            nodes.push(Node { domain, edges, bounds });
        }
    }
    if nodes.len() > MAX_SOURCES || layers.iter().any(|layer: &Layer| layer.targets() > MAX_WIDTH) {
        return None;
    }
    let mut cells = Vec::new();
    let mut sources = heapless::Vec::new();
    for node in &nodes {
        let first_cell = u16::try_from(cells.len()).ok()?;
        let (table, columns) = (0..=RELAXATIONS).find_map(|k| smallest(node, 2f64.powi(k)))?;
        for row in 0..table.cells() as usize {
            cells.extend(columns.iter().map(|column| column.get(row).copied().unwrap_or_default()));
        }
        sources.push(Source { table, first_cell }).ok()?;
    }
    let law = Law::Network(TableNetwork { layers, sources, outer: Outer::Linear });
    Some(Tables { law, cells, inputs: live.to_vec() })
}

fn layer_node(layer: &crate::kan::Layer, terminal: usize) -> usize {
    (0..layer.nodes.count()).find(|&node| layer.terminals_of(node).contains(&terminal)).unwrap_or(0)
}

/// How much the output moves at most with a sum that ends in `node` of layer `layer` (the output: by as much).
fn sensitivity(graph: &GraphSummary, curve: &NetworkCurve, layer: usize, node: usize) -> f64 {
    let outgoing = graph.edges.iter().filter(|edge| edge.active && edge.layer == layer && edge.from == node);
    let slopes: Vec<f64> = outgoing
        .filter_map(|edge| {
            let piecewise = curve.edges[layer][edge.terminal][edge.from].as_ref()?;
            let beyond = sensitivity(graph, curve, layer + 1, edge.to);
            Some(beyond * piecewise.steepest(edge.domain[0], edge.domain[1]))
        })
        .collect();
    if layer >= curve.edges.len() { 1.0 } else { slopes.iter().sum::<f64>().max(1e-12) }
}

/// The layout of fewest cells in which every activation of the node stays within its bound times `slack`.
fn smallest(node: &Node, slack: f64) -> Option<(Table, Vec<Vec<Cell>>)> {
    layouts(node.domain).into_iter().find_map(|table| {
        let mut columns = Vec::new();
        for (edge, bound) in node.edges.iter().zip(&node.bounds) {
            let Some(edge) = edge else {
                columns.push(Vec::new());
                continue;
            };
            let compiled = compile_layout(edge, table);
            if compiled.certificate.total() > bound * slack {
                return None;
            }
            columns.push(compiled.cells);
        }
        Some((table, columns))
    })
}

/// Layouts for a range, few cells first.
fn layouts([low, high]: [f64; 2]) -> Vec<Table> {
    let margin = 1e-6 * (high - low).max(1e-6);
    let (low, high) = ((low - margin) as f32, (high + margin) as f32);
    let mut tables: Vec<Table> = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128]
        .into_iter()
        .map(|cells| Table::Uniform(Uniform::new(UniformShape { first_cell: 0, cells, low, high })))
        .collect();
    if low < 0.0 && high > 0.0 {
        let coarsest = high.max(-low).log2().floor() as i32;
        for octave_cells_log2 in 0..=2 {
            for exponent in (coarsest - 8..=coarsest).rev() {
                tables.push(Table::Geometric(Geometric::new(GeometricShape {
                    first_cell: 0,
                    offset_exponent: exponent.clamp(-60, 60) as i8,
                    octave_cells_log2,
                    symmetry: Symmetry::Sided,
                    reach: high,
                    reach_negative: -low,
                })));
            }
        }
    }
    tables.sort_by_key(Table::cells);
    tables
}
