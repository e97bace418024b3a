//! Stated probabilities: how often a name with this margin and set turned out right on the synthetic library.

use super::search::Accepted;
use crate::physics::EffectId;

/// Frequency of a right first name by margin to the best rival in nats (upper end of the bin, frequency), measured on
/// the suite of concealed effects.
const LADDER: [(f64, f64); 5] = [(1.0, 0.55), (3.0, 0.65), (6.0, 0.89), (12.0, 0.97), (f64::INFINITY, 0.99)];

/// Calibrated probability that the named effect is the true one.
pub(crate) fn probability(found: &Accepted) -> f64 {
    let nearest = found.rivals.iter().map(|(_, distance)| *distance).fold(found.margin, f64::min);
    LADDER.iter().find(|(end, _)| nearest < *end).map_or(0.99, |(_, frequency)| *frequency)
}

/// What is left of the probability, shared among the rivals by their likelihood.
pub(crate) fn alternatives(found: &Accepted) -> Vec<(EffectId, f64)> {
    let left = 0.97 * (1.0 - probability(found));
    let weights: Vec<f64> = found.rivals.iter().map(|(_, distance)| (-distance).exp()).collect();
    let total: f64 = weights.iter().sum();
    found.rivals.iter().zip(&weights).map(|((effect, _), weight)| (*effect, left * weight / total)).collect()
}
