//! The network as a graph with scores, for reports and for the symbolic step.

use serde::{Deserialize, Serialize};

use super::attribution::Attribution;
use crate::kan::network::layers::Network;
use crate::kan::training::dataset::Dataset;

/// What a node does with what reaches it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NodeKind {
    /// An input of the network.
    Input,
    /// A sum of activations.
    Sum,
    /// A product of two sums of activations.
    Product,
    /// The output, a sum.
    Output,
}

/// One node.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GraphNode {
    /// Inputs are layer 0.
    pub layer: usize,
    /// Position in its layer.
    pub index: usize,
    /// What it does.
    pub kind: NodeKind,
    /// Attribution score.
    pub score: f64,
    /// Whether it still lies on a path from an input to the output.
    pub active: bool,
}

/// One activation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GraphEdge {
    /// Layer of the node that it leaves; also the `layer` of [`Network::edge_activation`].
    pub layer: usize,
    /// Node that it leaves.
    pub from: usize,
    /// Node that it reaches, in layer `layer + 1`.
    pub to: usize,
    /// Sum within that node, the `to` of [`Network::edge_activation`].
    pub terminal: usize,
    /// Attribution score.
    pub score: f64,
    /// False when pruned.
    pub active: bool,
    /// Range of its argument on the data; physical in the first layer.
    pub domain: [f64; 2],
    /// The function of the library that the activation follows, where the symbolic step found one.
    pub symbolic: Option<String>,
}

/// Nodes and edges, layer after layer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GraphSummary {
    /// All nodes, the inputs first, the output last.
    pub nodes: Vec<GraphNode>,
    /// All edges, pruned ones included.
    pub edges: Vec<GraphEdge>,
}

impl GraphSummary {
    /// Scores the network on the training rows of a data set.
    pub fn of(network: &Network, dataset: &Dataset) -> Self {
        let attribution = Attribution::of(network, dataset, &dataset.training_rows());
        let alive = network.live_nodes();
        let mut nodes = Vec::new();
        let mut edges = Vec::new();
        for (index, layer) in network.layers().iter().enumerate() {
            for node in 0..layer.inputs {
                let kind = match index.checked_sub(1).map(|before| network.layers()[before].nodes.sums) {
                    None => NodeKind::Input,
                    Some(sums) if node < sums => NodeKind::Sum,
                    Some(_) => NodeKind::Product,
                };
                let score = attribution.nodes[index][node];
                nodes.push(GraphNode { layer: index, index: node, kind, score, active: alive[index][node] });
            }
            for to in 0..layer.nodes.count() {
                for terminal in layer.terminals_of(to) {
                    for from in 0..layer.inputs {
                        edges.push(GraphEdge {
                            layer: index,
                            from,
                            to,
                            terminal,
                            score: attribution.edges[index][terminal * layer.inputs + from],
                            active: layer.edge(from, terminal).active,
                            domain: attribution.ranges[index][from],
                            symbolic: None,
                        });
                    }
                }
            }
        }
        let output = network.layers().len();
        nodes.push(GraphNode { layer: output, index: 0, kind: NodeKind::Output, score: 1.0, active: true });
        Self { nodes, edges }
    }

    /// Points of one activation over its domain, for a plot.
    pub fn curve(&self, network: &Network, edge: usize, points: usize) -> Vec<[f64; 2]> {
        let Some(edge) = self.edges.get(edge) else { return Vec::new() };
        let [low, high] = edge.domain;
        (0..points)
            .map(|i| {
                let x = low + (high - low) * i as f64 / points.saturating_sub(1).max(1) as f64;
                [x, network.edge_activation(edge.layer, edge.from, edge.terminal, x)]
            })
            .collect()
    }
}

impl Network {
    /// `[layer][node]`: nodes, inputs first, that lie on a path of active edges from an input to the output.
    pub fn live_nodes(&self) -> Vec<Vec<bool>> {
        let mut reached: Vec<Vec<bool>> = vec![vec![true; self.layers[0].inputs]];
        for (index, layer) in self.layers.iter().enumerate() {
            let fed = |terminal: usize| (0..layer.inputs).any(|i| layer.edge(i, terminal).active && reached[index][i]);
            reached.push((0..layer.nodes.count()).map(|node| layer.terminals_of(node).all(fed)).collect());
        }
        let mut live = vec![vec![true]];
        for (index, layer) in self.layers.iter().enumerate().rev() {
            let heard = |from: usize| {
                (0..layer.nodes.count())
                    .filter(|&node| live[live.len() - 1][node])
                    .any(|node| layer.terminals_of(node).any(|to| layer.edge(from, to).active))
            };
            let nodes = (0..layer.inputs).map(|from| reached[index][from] && heard(from)).collect();
            live.push(nodes);
        }
        live.reverse();
        live
    }

    /// Switches off every edge that leaves or reaches a node off all paths.
    pub(in crate::kan) fn drop_dead_edges(&mut self) {
        let live = self.live_nodes();
        for (index, layer) in self.layers.iter_mut().enumerate() {
            for node in 0..layer.nodes.count() {
                for terminal in layer.terminals_of(node) {
                    for from in 0..layer.inputs {
                        let edge = &mut layer.edges[terminal * layer.inputs + from];
                        edge.active &= live[index][from] && live[index + 1][node];
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_product_without_one_factor_takes_its_edges_with_it() {
        let mut network = Network::zeros(&"[1,[1,1],1]".parse().unwrap()).unwrap();
        network.set_active(0, 0, 2, false).unwrap();
        assert_eq!(network.live_nodes(), [vec![true], vec![true, false], vec![true]]);
        network.drop_dead_edges();
        assert_eq!(network.active_edges().count(), 2);
    }
}
