//! Initial weights: hidden nodes that already carry the main effects of the inputs, each in another blend.

use super::initial_linear_fit::InitialLinearFit;
use crate::kan::network::architecture::Architecture;
use crate::kan::network::error::KanError;
use crate::kan::network::knots::stretched;
use crate::kan::network::layers::Network;
use crate::kan::network::random::Random;
use crate::kan::network::spline::{Grid, SplineBasis};

/// Hidden values start within this share of the next layer's grid.
const GRID_SHARE: f64 = 0.9;

/// A network whose first layer blends each input's effect with its knot placement, and whose last layer is zero:
/// the first step of training solves for that one. Without hidden layers it is the initial linear fit on as many cells; further starts move
/// its knots.
pub(in crate::kan) fn initial_weights(
    architecture: &Architecture,
    linear_fit: &InitialLinearFit,
    seed: u64,
    restart: usize,
) -> Result<Network, KanError> {
    let random = &mut Random::new(seed, restart as u64);
    let mut network = Network::zeros(architecture)?;
    let mut bases = Vec::new();
    for (index, layer) in network.layers().iter().enumerate() {
        for position in 0..layer.edges.len() {
            let resolution = architecture.resolution(index, position % layer.inputs);
            // Several splines share the work by having their knots between each other's.
            let alone = architecture.hidden.is_empty() && restart == 0;
            let stretch = if alone { 0.0 } else { random.uniform(-1.0, 1.0) };
            let breaks = match index {
                0 => linear_fit.placements[position % layer.inputs].breaks(resolution.cells, stretch),
                _ => stretched(resolution.cells, stretch).map(|share| 2.0 * share - 1.0).collect(),
            };
            bases.push(SplineBasis::new(Grid { order: resolution.order, breaks })?);
        }
    }
    network.set_bases(bases);

    let depth = network.layers().len();
    for index in 0..depth.saturating_sub(1) {
        let (inputs, terminals) = (network.layers()[index].inputs, network.layers()[index].nodes.terminals());
        for to in 0..terminals {
            let weights = unit_weights(inputs, random);
            // Spread evenly between the bare placement and the bare effect, so that the nodes differ.
            let blend = (to as f64 + random.unit()) / terminals as f64;
            for (from, weight) in weights.into_iter().enumerate() {
                let position = to * inputs + from;
                if index == 0 {
                    let (low, high) = effect_range(linear_fit, from);
                    let curve = |x: f64| {
                        let place = 2.0 * linear_fit.placements[from].share_below(x) - 1.0;
                        let effect = 2.0 * (linear_fit.effect(from, x.clamp(-1.0, 1.0)) - low) / (high - low) - 1.0;
                        GRID_SHARE * weight * ((1.0 - blend) * place + blend * effect)
                    };
                    network.set_curve(index, position, curve);
                } else {
                    network.set_curve(index, position, |x| GRID_SHARE * weight * x);
                }
            }
        }
    }
    Ok(network)
}

/// Random weights whose absolute values sum to one.
fn unit_weights(count: usize, random: &mut Random) -> Vec<f64> {
    let weights: Vec<f64> = (0..count).map(|_| random.sign() * random.uniform(0.2, 1.0)).collect();
    let total: f64 = weights.iter().map(|w| w.abs()).sum();
    weights.into_iter().map(|w| w / total).collect()
}

/// Least and greatest value of an input's effect; never equal.
fn effect_range(linear_fit: &InitialLinearFit, input: usize) -> (f64, f64) {
    let values = (0..=100).map(|i| linear_fit.effect(input, -1.0 + 0.02 * i as f64));
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
    if high - low > 1e-9 { (low, high) } else { (low - 1.0, low + 1.0) }
}
