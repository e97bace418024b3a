//! P4 and P6: network, pruning, symbolic step, formula; clean and under 5 % noise.

use std::slice::from_ref;
use std::time::Instant;

use frikan_trainer::fit::label_activations;
use frikan_trainer::kan::{Blocks, Dataset, FitOptions, GraphSummary, Network, PruneOptions, Random, fit, prune};
use frikan_trainer::law::{Discovery, Language, SearchOptions, discover, render};

use super::{JOINTS, SAMPLES, r2, samples};
use crate::laws::{data, velocity};

/// The way from samples to a formula.
#[derive(Clone, Debug)]
pub struct Symbolic {
    /// The graph as trained, pruned, and with the functions that its activations follow.
    pub graphs: [GraphSummary; 3],
    /// The pruned network.
    pub network: Network,
    /// What the search found.
    pub found: Discovery,
    /// The formula.
    pub formula: String,
    /// Nodes of the formula.
    pub nodes: usize,
    /// R2 of the formula against the clean truth on other samples.
    pub r2: f64,
    /// Time of all of it.
    pub seconds: f64,
}

/// Fits `[1,[5,2],1]`, prunes, matches the activations and looks for the law.
///
/// # Panics
/// When the samples cannot be used, which they can.
#[must_use]
pub fn symbolic(joint: usize, share: f64, seed: u64) -> Symbolic {
    let mut random = Random::new(50_000 + seed, joint as u64);
    let samples = samples(JOINTS[joint], SAMPLES, share, &mut random);
    let test = super::samples(JOINTS[joint], 2 * SAMPLES, 0.0, &mut random);
    let start = Instant::now();
    let blocks = Blocks::default();
    let set = Dataset { inputs: from_ref(&samples.velocity), target: &samples.noisy, linear: &[], blocks: &blocks };
    let options = FitOptions { seed, ..FitOptions::new("[1,[5,2],1]".parse().expect("a shape")) };
    let trained = fit(&set, &options, &|_| ()).expect("usable samples");
    let pruned = prune(&trained, &set, &options, &PruneOptions::default(), &|_| ()).expect("usable samples").result;
    let before = GraphSummary::of(&trained.network, &set);
    let after = GraphSummary::of(&pruned.network, &set);
    let mut labelled = after.clone();
    label_activations(&mut labelled, &pruned.network);
    let law = data(vec![velocity(samples.velocity.clone())], samples.noisy.clone());
    let found = discover(&law, &SearchOptions::default()).expect("usable samples");
    let seconds = start.elapsed().as_secs_f64();
    let expression = &found.law.expression;
    let predicted: Vec<f64> = test.velocity.iter().map(|v| expression.value(&[*v], &[])).collect();
    Symbolic {
        graphs: [before, after, labelled],
        network: pruned.network,
        formula: render(expression, Language::Unicode, &["v"]),
        nodes: expression.node_count(),
        r2: r2(&test.clean, &predicted),
        found,
        seconds,
    }
}
