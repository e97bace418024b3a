//! What the activations of the pruned network look like: labels for its picture, starts for the search of the formula.

use crate::fit::data::inputs::ChosenInput;
use crate::fit::outcome::CURVE_POINTS;
use crate::kan::{GraphEdge, GraphSummary, Network, NodeKind};
use crate::law::{Activation, Start, matches, proposals};

/// An activation is labelled with a function that leaves less than this share of its variance unexplained.
const LABEL_THRESHOLD: f64 = 1e-3;

/// Writes into the graph which function each activation follows, where it follows one.
pub fn label_activations(graph: &mut GraphSummary, network: &Network) {
    for index in (0..graph.edges.len()).filter(|&index| graph.edges[index].active).collect::<Vec<_>>() {
        let found = matches(&graph.curve(network, index, CURVE_POINTS)).into_iter().next();
        graph.edges[index].symbolic =
            found.filter(|best| best.unexplained < LABEL_THRESHOLD).map(|best| best.function.label().to_owned());
    }
}

/// Where the search may start. Only networks with at most one hidden layer say something about terms.
pub(in crate::fit) fn starts(network: &Network, graph: &GraphSummary, inputs: &[ChosenInput]) -> Vec<Start> {
    if network.layers().len() > 2 {
        return Vec::new();
    }
    let reaching = |terminal: usize| -> Vec<&GraphEdge> {
        graph.edges.iter().filter(|edge| edge.active && edge.layer == 0 && edge.terminal == terminal).collect()
    };
    let (mut sums, mut products) = (Vec::new(), Vec::new());
    for node in graph.nodes.iter().filter(|node| node.layer == 1 && node.active) {
        let terminals: Vec<Vec<&GraphEdge>> = network.layers()[0].terminals_of(node.index).map(reaching).collect();
        match (node.kind, terminals.as_slice()) {
            (NodeKind::Product, [left, right]) => {
                for (a, b) in left.iter().flat_map(|a| right.iter().map(move |b| (a, b))) {
                    let factor = |edge| activation(network, edge, inputs, |x| x);
                    products.extend(factor(a).zip(factor(b)).map(|(a, b)| [a, b]));
                }
            }
            // What one activation hands on, the next one bends further.
            (NodeKind::Sum, [one]) if one.len() == 1 => {
                let outwards = |x| network.edge_activation(1, node.index, 0, x);
                sums.extend(activation(network, one[0], inputs, outwards));
            }
            (_, all) => {
                sums.extend(all.iter().flatten().filter_map(|edge| activation(network, edge, inputs, |x| x)));
            }
        }
    }
    proposals(&sums, &products)
}

fn activation(
    network: &Network,
    edge: &GraphEdge,
    inputs: &[ChosenInput],
    outwards: impl Fn(f64) -> f64,
) -> Option<Activation> {
    let [low, high] = edge.domain;
    let at = |i: usize| low + (high - low) * i as f64 / (CURVE_POINTS - 1) as f64;
    let value = |x| outwards(network.edge_activation(edge.layer, edge.from, edge.terminal, x));
    Some(Activation {
        channel: edge.from,
        role: inputs.get(edge.from)?.role,
        points: (0..CURVE_POINTS).map(|i| [at(i), value(at(i))]).collect(),
    })
}
