//! Stated probabilities: how often a name with this margin and set turned out right on the synthetic library.

use super::search::Accepted;
use crate::physics::EffectId;

/// Frequency of a right first name by the number of rivals that cannot be ruled out (two and more in the last), measured
/// on some six hundred concealed effects of other seeds than the report's.
const BY_RIVALS: [f64; 3] = [0.98, 0.80, 0.62];
/// The same without such a rival where the next one stands closer than [`CLEAR_NATS`].
const NARROWLY_ALONE: f64 = 0.85;
/// Margin in nats from which a name that stands alone was hardly ever wrong there.
const CLEAR_NATS: f64 = 6.0;

/// Calibrated probability that the named effect is the true one.
pub(crate) fn probability(found: &Accepted) -> f64 {
    match found.rivals.len() {
        0 if found.margin < CLEAR_NATS => NARROWLY_ALONE,
        rivals => BY_RIVALS[rivals.min(BY_RIVALS.len() - 1)],
    }
}

/// What is left of the probability, shared among the rivals by their likelihood.
pub(crate) fn alternatives(found: &Accepted) -> Vec<(EffectId, f64)> {
    let left = 0.97 * (1.0 - probability(found));
    let weights: Vec<f64> = found.rivals.iter().map(|(_, distance)| (-distance).exp()).collect();
    let total: f64 = weights.iter().sum();
    found.rivals.iter().zip(&weights).map(|((effect, _), weight)| (*effect, left * weight / total)).collect()
}
