//! A trained network as the tables of a drive: one certified table for one input, a network of tables for several.

mod piecewise;

use frikan_shared::model::Law;
use frikan_shared::network::{MAX_WIDTH, Network as TableNetwork};
use frikan_shared::table::{Cell, Geometric, GeometricShape, Symmetry, Table, Uniform, UniformShape};

use crate::compile::formula::Curve;
use crate::compile::networks::{COORDINATE_ERROR, Edge, Edges, Nodes, assemble, node_ranges};
use crate::compile::tables::{self, compile_table};
use crate::kan::{GraphSummary, Network};

use piecewise::{NetworkCurve, Piecewise};

/// A law as tables.
#[derive(Clone, Debug)]
pub(in crate::fit) struct Tables {
    pub(in crate::fit) law: Law,
    pub(in crate::fit) cells: Vec<Cell>,
    /// Positions of the inputs that the law reads, in its order.
    pub(in crate::fit) inputs: Vec<usize>,
}

/// How often the bound of a layer is doubled where no layout meets it: bounds for the worst case are strict.
const RELAXATIONS: i32 = 8;

/// Compiles `network` to within `bound` (unit of the output; for several inputs in the worst case, which is far from the
/// usual one). `ranges` are those of all its inputs. `None` when it does not fit a drive's tables.
pub(in crate::fit) fn compile(
    network: &Network,
    graph: &GraphSummary,
    ranges: &[[f64; 2]],
    bound: f64,
) -> Option<Tables> {
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

/// A node with outgoing activations.
struct Node {
    /// One activation for each sum of the next layer, `None` where pruned.
    edges: Vec<Option<Piecewise>>,
    /// Error that each activation may have.
    bounds: Vec<f64>,
}

impl Node {
    /// The edges over rows, where all stay within their bounds times `slack`.
    fn over(&self, (rows, coordinate_error): &(Vec<(f64, f64)>, f64), slack: f64) -> Option<Vec<Edge>> {
        let compile = |(curve, bound): (&Option<Piecewise>, &f64)| {
            let edge = Edge::new(curve.as_ref().map(|curve| curve as &dyn Curve), rows, *coordinate_error);
            (edge.error <= bound * slack).then_some(edge)
        };
        self.edges.iter().zip(&self.bounds).map(compile).collect()
    }
}

fn several(network: &Network, graph: &GraphSummary, live: &[usize], bound: f64) -> Option<Tables> {
    let curve = NetworkCurve::of(network);
    let alive = network.live_nodes();
    let depth = network.layers().len();
    let active = graph.edges.iter().filter(|edge| edge.active).count().max(1) as f64;
    let (mut layouts, mut edges, mut hidden) = (Vec::new(), Vec::new(), Vec::new());
    // Ranges of the nodes that the edges of a layer leave.
    let mut domains: Vec<[f64; 2]> = Vec::new();
    for (index, layer) in network.layers().iter().enumerate() {
        let kept: Vec<usize> = (0..layer.nodes.count()).filter(|&node| alive[index + 1][node]).collect();
        let terminals: Vec<usize> = kept.iter().flat_map(|&node| layer.terminals_of(node)).collect();
        let additive = kept.iter().filter(|&&node| node < layer.nodes.sums).count();
        let last = index + 1 == depth;
        let sums = if last { 1 } else { 2 * kept.len() - additive };
        if terminals.len() != sums || sums > MAX_WIDTH {
            return None;
        }
        let mut centre = last.then_some(network.output.centre);
        let mut nodes = Vec::new();
        for from in (0..layer.inputs).filter(|&from| alive[index][from]) {
            let mut edges: Vec<Option<Piecewise>> =
                terminals.iter().map(|&to| curve.edges[index][to][from].clone()).collect();
            // The output's centre goes into the first activation of the last layer.
            if let Some(edge) = edges.iter_mut().flatten().next()
                && let Some(centre) = centre.take()
            {
                *edge = edge.clone().raised(centre);
            }
            if index == 0 {
                domains.push(graph.edges.iter().find(|e| e.layer == index && e.from == from)?.domain);
            }
            let bounds = terminals
                .iter()
                .map(|&to| bound / (active * sensitivity(graph, &curve, index + 1, layer_node(layer, to))))
                .collect();
            nodes.push(Node { edges, bounds });
        }
        let slacks = (0..=RELAXATIONS).map(|k| 2f64.powi(k));
        let found = if index == 0 {
            let (tables, edges) = slacks.into_iter().find_map(|slack| smallest_layouts(&nodes, &domains, slack))?;
            layouts = tables;
            edges
        } else {
            slacks.into_iter().find_map(|slack| smallest_rows(&nodes, &domains, slack))?
        };
        if !last {
            let into = Nodes { additive: additive as u8, products: (kept.len() - additive) as u8 };
            domains = node_ranges(&found, into);
            hidden.push(into);
        }
        edges.push(found);
    }
    let (network, cells) = assemble(&layouts, &edges, &hidden)?;
    Some(Tables { law: Law::Network(network), cells, inputs: live.to_vec() })
}

/// What validation allows a network to put out, in the unit of the output.
pub(in crate::fit) fn output_bound(network: &TableNetwork) -> f64 {
    f64::from(i32::MAX) * f64::from(network.output_step)
}

/// For each input the layout of fewest rows in which its activations stay within their bounds times `slack`, and their edges over it.
fn smallest_layouts(nodes: &[Node], domains: &[[f64; 2]], slack: f64) -> Option<(Vec<Table>, Edges)> {
    let found = nodes.iter().zip(domains).map(|(node, domain)| {
        layouts(*domain).into_iter().find_map(|table| Some((table, node.over(&tables::rows(table), slack)?)))
    });
    Some(found.collect::<Option<Vec<_>>>()?.into_iter().unzip())
}

/// The edges over the fewest equal rows in which the activations of all nodes of a layer stay within their bounds times `slack`.
fn smallest_rows(nodes: &[Node], domains: &[[f64; 2]], slack: f64) -> Option<Edges> {
    ROWS.into_iter().find_map(|count| {
        let edges = nodes.iter().zip(domains).map(|(node, &[low, high])| {
            let end = |row: u16| low + (high - low) * f64::from(row) / f64::from(count);
            node.over(&((0..count).map(|row| (end(row), end(row + 1))).collect(), COORDINATE_ERROR), slack)
        });
        edges.collect()
    })
}

/// Numbers of equal rows that are tried.
const ROWS: [u16; 14] = [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128];

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

/// Layouts for a range, few cells first.
fn layouts([low, high]: [f64; 2]) -> Vec<Table> {
    let margin = 1e-6 * (high - low).max(1e-6);
    let (low, high) = ((low - margin) as f32, (high + margin) as f32);
    let mut tables: Vec<Table> = ROWS
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
