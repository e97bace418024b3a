//! A penalty that shrinks superfluous edges towards zero: the sizes of all edges are summed (l1), and their distribution over the network
//! is made uneven (entropy), after Liu et al. (2024).

use serde::{Deserialize, Serialize};

use super::model::{Model, Unknowns};
use crate::numerics::statistics::mean;

/// Weights of the two, relative to the mean squared error of the normalised target.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Sparsity {
    /// Weight of the sum of sizes.
    pub l1: f64,
    /// Weight of the entropy of their distribution.
    pub entropy: f64,
}

impl Sparsity {
    /// No penalty.
    pub const NONE: Self = Self { l1: 0.0, entropy: 0.0 };
}

/// Keeps the size of an edge smooth where it vanishes.
const SIZE_FLOOR: f64 = 1e-3;

/// The value of the penalty over the coefficients of a model. The size of an edge is the deviation of its coefficients from
/// their mean, so that a constant costs nothing.
#[derive(Clone, Debug)]
pub(in crate::kan) struct SparsityPenalty {
    sparsity: Sparsity,
    /// Coefficients of each active edge among the unknowns.
    edges: Vec<std::ops::Range<usize>>,
}

impl SparsityPenalty {
    /// `scale` times the penalty of the active edges of a model.
    pub(in crate::kan) fn of(
        model: &Model,
        unknowns: &Unknowns,
        Sparsity { l1, entropy }: Sparsity,
        scale: f64,
    ) -> Self {
        let layers = model.network.layers().iter().enumerate();
        let edges = layers.flat_map(|(index, layer)| {
            layer.edges.iter().enumerate().filter_map(move |(position, edge)| {
                unknowns.start(index, position).map(|start| start..start + edge.basis.len())
            })
        });
        let none = l1 == 0.0 && entropy == 0.0;
        let edges = if none { Vec::new() } else { edges.collect() };
        Self { sparsity: Sparsity { l1: scale * l1, entropy: scale * entropy }, edges }
    }

    fn sizes(&self, values: &[f64]) -> Vec<f64> {
        let size = |edge: &std::ops::Range<usize>| {
            let coefficients = &values[edge.clone()];
            let mean = mean(coefficients);
            let square = coefficients.iter().map(|c| (c - mean).powi(2)).sum::<f64>() / coefficients.len() as f64;
            (square + SIZE_FLOOR * SIZE_FLOOR).sqrt()
        };
        self.edges.iter().map(size).collect()
    }

    pub(in crate::kan) fn value(&self, values: &[f64]) -> f64 {
        let sizes = self.sizes(values);
        let (total, entropy) = total_and_entropy(&sizes);
        self.sparsity.l1 * total + self.sparsity.entropy * entropy
    }

    /// Derivative of the penalty with respect to the mean square of each edge.
    fn weights(&self, values: &[f64]) -> Vec<f64> {
        let sizes = self.sizes(values);
        let (total, entropy) = total_and_entropy(&sizes);
        let slope = |size: f64| self.sparsity.l1 - self.sparsity.entropy * ((size / total).ln() + entropy) / total;
        sizes.iter().map(|&size| 0.5 * slope(size) / size).collect()
    }

    /// Adds `factor` times half the gradient of the penalty.
    pub(in crate::kan) fn add_gradient(&self, values: &[f64], factor: f64, gradient: &mut [f64]) {
        for (edge, weight) in self.edges.iter().zip(self.weights(values)) {
            let coefficients = &values[edge.clone()];
            let (mean, weight) = (mean(coefficients), factor * weight / coefficients.len() as f64);
            for (slot, c) in gradient[edge.clone()].iter_mut().zip(coefficients) {
                *slot += weight * (c - mean);
            }
        }
    }

    /// Adds half the second derivative of a parabola that lies above the penalty to the upper triangle of a matrix. Where the
    /// entropy favours an edge, it adds nothing.
    pub(in crate::kan) fn add_curvature(&self, values: &[f64], size: usize, matrix: &mut [f64]) {
        for (edge, weight) in self.edges.iter().zip(self.weights(values)) {
            let count = edge.len() as f64;
            let weight = weight.max(0.0) / count;
            for i in edge.clone() {
                for j in i..edge.end {
                    matrix[i * size + j] += weight * (f64::from(u8::from(i == j)) - 1.0 / count);
                }
            }
        }
    }
}

/// Sum of sizes, and the entropy of their shares in it.
fn total_and_entropy(sizes: &[f64]) -> (f64, f64) {
    let total: f64 = sizes.iter().sum();
    (total, sizes.iter().map(|size| -size / total * (size / total).ln()).sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kan::{Architecture, Network};

    fn penalty(sparsity: Sparsity) -> (SparsityPenalty, Vec<f64>) {
        let network = Network::zeros(&Architecture::additive(1, &[3])).unwrap();
        let model = Model { network, linear: Vec::new(), linear_width: Vec::new() };
        let unknowns = Unknowns::of(&model, false);
        let values = (0..unknowns.len()).map(|i| (1.3 * i as f64).sin() * (1.0 + 0.1 * i as f64)).collect();
        (SparsityPenalty::of(&model, &unknowns, sparsity, 2.0), values)
    }

    #[test]
    fn the_gradient_is_that_of_the_penalty() {
        for sparsity in [Sparsity { l1: 0.7, entropy: 0.0 }, Sparsity { l1: 0.0, entropy: 0.4 }] {
            let (penalty, values) = penalty(sparsity);
            let mut gradient = vec![0.0; values.len()];
            penalty.add_gradient(&values, 2.0, &mut gradient);
            for i in 0..values.len() {
                let moved = |by: f64| {
                    let mut moved = values.clone();
                    moved[i] += by;
                    penalty.value(&moved)
                };
                let numeric = (moved(1e-6) - moved(-1e-6)) / 2e-6;
                assert!((numeric - gradient[i]).abs() < 1e-7, "{i}: {numeric} and {}", gradient[i]);
            }
        }
    }

    #[test]
    fn one_large_edge_has_less_entropy_than_many_alike() {
        let (penalty, mut values) = penalty(Sparsity { l1: 0.0, entropy: 1.0 });
        let before = penalty.value(&values);
        values[13..].iter_mut().for_each(|v| *v *= 0.001);
        assert!(penalty.value(&values) < 0.3 * before);
    }
}
