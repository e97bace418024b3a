//! Which nodes and edges matter: attribution scores from the spread of activations, propagated backwards
//! (Liu et al., 2024).

use std::ops::Range;

use crate::kan::network::layers::Network;
use crate::kan::network::trace::Trace;
use crate::kan::training::dataset::{Dataset, fold_chunks, row_count};

/// Scores of a network on a data set. The output has score one; what a sum receives it hands to its edges in
/// proportion to their standard deviation over that of the sum; a product hands its score to both its factors.
#[derive(Clone, Debug, PartialEq)]
pub struct Attribution {
    /// `[layer][edge]`, edges as in [`crate::kan::Layer::edges`]; pruned edges score zero.
    pub edges: Vec<Vec<f64>>,
    /// `[layer][node]`: nodes that feed the layer; `nodes[0]` are the inputs.
    pub nodes: Vec<Vec<f64>>,
    /// `[layer][node]`: least and greatest value that each of these nodes took. Inputs are in physical units.
    pub ranges: Vec<Vec<[f64; 2]>>,
}

/// Keeps a constant sum from dividing by zero.
const LEAST_DEVIATION: f64 = 1e-4;

/// Sums over samples for one layer.
#[derive(Clone)]
struct Spread {
    edges: Vec<[f64; 2]>,
    terminals: Vec<[f64; 2]>,
    ranges: Vec<[f64; 2]>,
}

impl Attribution {
    /// Scores on some rows of a data set.
    pub fn of(network: &Network, dataset: &Dataset, rows: &[Range<usize>]) -> Self {
        let spreads = spreads(network, dataset, rows);
        let samples = row_count(rows).max(1) as f64;
        let deviation = |[sum, squares]: [f64; 2]| (squares / samples - (sum / samples).powi(2)).max(0.0).sqrt();
        let mut edges = Vec::new();
        let mut nodes = Vec::new();
        let mut score = vec![1.0];
        for (layer, spread) in network.layers().iter().zip(&spreads).rev() {
            let mut terminal_score = vec![0.0; layer.nodes.terminals()];
            for (node, score) in score.iter().enumerate() {
                terminal_score[layer.terminals_of(node)].fill(*score);
            }
            let mut below = vec![0.0; layer.inputs];
            let edge_scores: Vec<f64> = (0..layer.edges.len())
                .map(|position| {
                    let to = position / layer.inputs;
                    let share = deviation(spread.edges[position]) / (deviation(spread.terminals[to]) + LEAST_DEVIATION);
                    let score = if layer.edges[position].active { share * terminal_score[to] } else { 0.0 };
                    below[position % layer.inputs] += score;
                    score
                })
                .collect();
            edges.push(edge_scores);
            nodes.push(below.clone());
            score = below;
        }
        edges.reverse();
        nodes.reverse();
        let mut ranges: Vec<Vec<[f64; 2]>> = spreads.into_iter().map(|spread| spread.ranges).collect();
        for (range, scaling) in ranges[0].iter_mut().zip(&network.inputs) {
            *range = range.map(|value| scaling.restore(value));
        }
        Self { edges, nodes, ranges }
    }
}

fn spreads(network: &Network, dataset: &Dataset, rows: &[Range<usize>]) -> Vec<Spread> {
    let empty: Vec<Spread> = network
        .layers()
        .iter()
        .map(|layer| Spread {
            edges: vec![[0.0; 2]; layer.edges.len()],
            terminals: vec![[0.0; 2]; layer.nodes.terminals()],
            ranges: vec![[f64::INFINITY, f64::NEG_INFINITY]; layer.inputs],
        })
        .collect();
    let chunk = |rows: &[Range<usize>]| {
        let mut trace = Trace::new(network);
        let mut spreads = empty.clone();
        for row in rows.iter().cloned().flatten() {
            trace.forward(network, |i| network.inputs[i].normalise(dataset.inputs[i][row]));
            for (index, (spread, layer)) in spreads.iter_mut().zip(network.layers()).enumerate() {
                for (position, sums) in spread.edges.iter_mut().enumerate() {
                    add(sums, trace.edge(index, position, layer.inputs).1.value);
                }
                spread.terminals.iter_mut().zip(trace.sums(index)).for_each(|(sums, value)| add(sums, *value));
                for ([low, high], value) in spread.ranges.iter_mut().zip(trace.inputs(index)) {
                    (*low, *high) = (low.min(*value), high.max(*value));
                }
            }
        }
        spreads
    };
    fold_chunks(rows, empty.clone(), chunk, |mut all, part| {
        for (sum, part) in all.iter_mut().zip(part) {
            let pairs = sum.edges.iter_mut().zip(part.edges).chain(sum.terminals.iter_mut().zip(part.terminals));
            pairs.for_each(|(a, b)| (a[0], a[1]) = (a[0] + b[0], a[1] + b[1]));
            sum.ranges.iter_mut().zip(part.ranges).for_each(|(a, b)| *a = [a[0].min(b[0]), a[1].max(b[1])]);
        }
        all
    })
}

fn add(sums: &mut [f64; 2], value: f64) {
    sums[0] += value;
    sums[1] += value * value;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kan::Blocks;

    /// Two inputs; hidden sum and product; the second input reaches only the product, whose weight varies.
    fn network(weight: f64) -> Network {
        let mut network = Network::zeros(&"[2,[1,1],1]".parse().unwrap()).unwrap();
        network.set_curve(0, 0, |x| x); // sum: input 0
        network.set_curve(0, 2, |x| x); // left factor: input 0
        network.set_curve(0, 5, |x| x); // right factor: input 1
        network.set_curve(1, 0, |x| x);
        network.set_curve(1, 1, |x| weight * x);
        network
    }

    #[test]
    fn products_hand_their_score_to_both_factors_and_scores_follow_the_spread() {
        let inputs = [
            (0..400).map(|i| (f64::from(i) * 0.41).sin()).collect::<Vec<_>>(),
            (0..400).map(|i| (f64::from(i) * 1.71).cos()).collect::<Vec<_>>(),
        ];
        let target = vec![0.0; 400];
        let blocks = Blocks::default();
        let dataset = Dataset { inputs: &inputs, target: &target, linear: &[], blocks: &blocks };
        let scores = Attribution::of(&network(1.0), &dataset, &dataset.training_rows());
        let product = scores.nodes[1][1];
        assert!((scores.edges[0][2] - product).abs() < 1e-3 && (scores.edges[0][5] - product).abs() < 1e-3);
        assert!(scores.edges[0][1] < 1e-9 && scores.edges[0][3] < 1e-9);
        assert!((scores.nodes[0][1] - product).abs() < 1e-3);
        assert_eq!(scores.ranges[0][0][0], inputs[0].iter().copied().fold(0.0, f64::min));
        // A product of no weight leaves its second input without a score.
        assert!(Attribution::of(&network(0.0), &dataset, &dataset.training_rows()).nodes[0][1] < 1e-9);
    }
}
