//! Pruning from the bottom up: nodes, edges, inputs; every removal is followed by a refit that has to confirm it.

use serde::{Deserialize, Serialize};

use super::attribution::Attribution;
use crate::kan::network::error::KanError;
use crate::kan::network::layers::Network;
use crate::kan::training::dataset::Dataset;
use crate::kan::training::fit::{FitOptions, FitResult, Trained, refit_from};
use crate::kan::training::settings::ProgressCallback;
use crate::numerics::jackknife::{ERROR_BLOCKS, even_blocks};
use std::ops::Range;

/// What may be removed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PruneOptions {
    /// Edges of a lower score are removed together.
    pub edge_threshold: f64,
    /// Rise of the error criterion, relative, that a removal may cost where too few rows are held out for a standard error of it. Negative
    /// values demand an improvement.
    pub tolerance: f64,
    /// Root-mean-square error, relative to the target's standard deviation, that is as good as none.
    pub negligible: f64,
    /// Steps of each refit.
    pub refit_steps: usize,
}

impl Default for PruneOptions {
    /// Two per cent of criterion; an error of a thousandth of the target's deviation counts as none.
    fn default() -> Self {
        Self { edge_threshold: 3e-2, tolerance: 0.02, negligible: 1e-3, refit_steps: 30 }
    }
}

/// Something that pruning took away, with the score that it had.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Removed {
    /// A hidden node; `layer` 1 is the first hidden layer.
    Node {
        /// Layer of the node.
        layer: usize,
        /// Position in the layer.
        index: usize,
        /// Attribution score.
        score: f64,
    },
    /// An activation; `to` counts terminals.
    Edge {
        /// Layer that the edge leaves.
        layer: usize,
        /// Node that it leaves.
        from: usize,
        /// Terminal that it reaches.
        to: usize,
        /// Attribution score.
        score: f64,
    },
    /// An input.
    Input {
        /// Which.
        index: usize,
        /// Attribution score.
        score: f64,
    },
}

impl Removed {
    fn score(&self) -> f64 {
        match self {
            Self::Node { score, .. } | Self::Edge { score, .. } | Self::Input { score, .. } => *score,
        }
    }

    fn apply(&self, network: &mut Network) {
        let (target_layer, keeps): (usize, Box<dyn Fn(usize, usize) -> bool>) = match *self {
            Self::Node { layer, index, .. } => (layer, Box::new(move |from, _| from != index)),
            Self::Edge { layer, from, to, .. } => (layer, Box::new(move |f, t| (f, t) != (from, to))),
            Self::Input { index, .. } => (0, Box::new(move |from, _| from != index)),
        };
        let layer = &mut network.layers[target_layer];
        let inputs = layer.inputs;
        for (position, edge) in layer.edges.iter_mut().enumerate() {
            edge.active &= keeps(position % inputs, position / inputs);
        }
        network.drop_dead_edges();
    }
}

/// A pruned fit.
#[derive(Clone, Debug, PartialEq)]
pub struct Pruned {
    /// The refitted network, with the history of the last refit.
    pub result: FitResult,
    /// What went, in that order.
    pub removed: Vec<Removed>,
}

/// Fewest pieces of held-out rows by whose scatter the error of a criterion is told.
const LEAST_PIECES: usize = 3;

/// Prunes a trained network: hidden nodes one at a time, weakest first, then weak edges, then inputs. What is left is the smallest that is found
/// within one standard error of the best held-out error (Breiman, Friedman, Olshen & Stone 1984).
///
/// # Errors
/// As [`crate::kan::fit`].
pub fn prune(
    fitted: &FitResult,
    dataset: &Dataset,
    options: &FitOptions,
    pruning: &PruneOptions,
    progress: ProgressCallback,
) -> Result<Pruned, KanError> {
    dataset.check(fitted.network.inputs.len())?;
    let refit_options = FitOptions { steps: pruning.refit_steps, ..options.clone() };
    let noise_variance = (fitted.train_rmse / fitted.network.output.width).powi(2);
    let refit = |network: Network, linear: &[f64]| {
        refit_from(network, linear, noise_variance, dataset, &refit_options, progress)
    };
    let mut current = refit(fitted.network.clone(), &fitted.linear_coefficients);
    let limit_of = |best: &Trained| {
        let rise = standard_error(best, dataset).unwrap_or(pruning.tolerance * best.criterion);
        (best.criterion + rise).max(pruning.negligible.powi(2))
    };
    let (mut best, mut limit) = (current.criterion, limit_of(&current));
    let mut removed = Vec::new();

    for stage in [nodes, edges, inputs] {
        let mut candidates = stage(&current.model.network, dataset, pruning);
        candidates.sort_by(|a, b| score_of(a).total_cmp(&score_of(b)));
        for group in candidates {
            let mut network = current.model.network.clone();
            group.iter().for_each(|removal| removal.apply(&mut network));
            if network.active_edges().count() == 0 {
                continue;
            }
            let trial = refit(network, &current.model.linear_coefficients());
            if trial.criterion <= limit {
                if trial.criterion < best {
                    (best, limit) = (trial.criterion, limit_of(&trial));
                }
                current = trial;
                removed.extend(group);
            }
        }
    }
    Ok(Pruned { result: current.into_result(dataset, 0), removed })
}

/// Standard error of the mean square over held-out rows, from the scatter over pieces of them, of a ratio of sums over pieces of unequal size (Cochran
/// 1977); `None` where there are too few.
fn standard_error(trained: &Trained, dataset: &Dataset) -> Option<f64> {
    let blocks = &dataset.blocks.validation;
    let rows: usize = blocks.iter().map(ExactSizeIterator::len).sum();
    let cut = |block: &Range<usize>| {
        let parts = even_blocks(block.len(), (ERROR_BLOCKS * block.len()).div_ceil(rows));
        let begin = block.start;
        parts.into_iter().map(move |part| begin + part.start..begin + part.end)
    };
    let pieces: Vec<Range<usize>> = blocks.iter().flat_map(cut).collect();
    if pieces.len() < LEAST_PIECES {
        return None;
    }
    let off = |piece: &Range<usize>| {
        let sum = trained.model.residual_sum(dataset, std::slice::from_ref(piece));
        sum - trained.criterion * piece.len() as f64
    };
    let scatter: f64 = pieces.iter().map(|piece| off(piece).powi(2)).sum();
    let inflation = pieces.len() as f64 / (pieces.len() - 1) as f64;
    Some((inflation * scatter).sqrt() / rows as f64)
}

fn score_of(group: &[Removed]) -> f64 {
    group.iter().map(Removed::score).fold(0.0, f64::max)
}

/// Every live hidden node, on its own.
fn nodes(network: &Network, dataset: &Dataset, _: &PruneOptions) -> Vec<Vec<Removed>> {
    let scores = Attribution::of(network, dataset, &dataset.training_rows()).nodes;
    let live = network.live_nodes();
    let hidden = 1..network.layers().len();
    hidden
        .flat_map(|layer| (0..scores[layer].len()).map(move |index| (layer, index)))
        .filter(|&(layer, index)| live[layer][index])
        .map(|(layer, index)| vec![Removed::Node { layer, index, score: scores[layer][index] }])
        .collect()
}

/// All edges below the threshold, together; and each on its own in case that is too much.
fn edges(network: &Network, dataset: &Dataset, pruning: &PruneOptions) -> Vec<Vec<Removed>> {
    let scores = Attribution::of(network, dataset, &dataset.training_rows()).edges;
    let mut weak = Vec::new();
    for (layer, edges) in network.layers().iter().enumerate() {
        for (position, edge) in edges.edges.iter().enumerate() {
            let score = scores[layer][position];
            if edge.active && score < pruning.edge_threshold {
                weak.push(Removed::Edge { layer, from: position % edges.inputs, to: position / edges.inputs, score });
            }
        }
    }
    if weak.is_empty() { Vec::new() } else { vec![weak] }
}

/// Every input that is still in use, on its own.
fn inputs(network: &Network, dataset: &Dataset, _: &PruneOptions) -> Vec<Vec<Removed>> {
    let scores = Attribution::of(network, dataset, &dataset.training_rows()).nodes;
    let live = network.live_nodes();
    let used = (0..live[0].len()).filter(|&index| live[0][index]);
    used.map(|index| vec![Removed::Input { index, score: scores[0][index] }]).collect()
}
