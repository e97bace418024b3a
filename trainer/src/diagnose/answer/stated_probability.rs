//! Stated probabilities: how often a name with this margin and set turned out right on the simulated suite (seeds 62000 and 64000 of
//! `cargo run --release -p frikan-tests --bin concealed-suite`). On recordings of other generators they are not checked.

use crate::diagnose::search::accepted::Accepted;
use crate::physics::EffectId;

/// Frequency of a right first name that stands alone, measured on some five hundred concealed effects of other seeds than the
/// report's.
const WITHOUT_RIVAL: f64 = 0.98;
/// The same where the next name stands closer than [`WIDE_MARGIN_NATS`].
const NEAR_MARGIN: f64 = 0.95;
/// The same beside rivals that cannot be ruled out, of which the nearest is [`FAR_RIVAL_NATS`] away or more.
const BESIDE_FAR_RIVALS: f64 = 0.8;
/// The same beside one nearer rival, and beside several of which one is nearer.
const BESIDE_A_NEAR_RIVAL: f64 = 0.75;
const BESIDE_NEAR_RIVALS: f64 = 0.5;
/// Margin in nats from which a name that stands alone was hardly ever wrong there.
const WIDE_MARGIN_NATS: f64 = 6.0;
/// Distance in nats from which a rival was seldom the truth.
const FAR_RIVAL_NATS: f64 = 1.5;

/// Probability that the named effect is the true one, by its margin and its rivals.
pub(crate) fn probability(found: &Accepted) -> f64 {
    let nearest = found.rivals.iter().map(|(_, distance)| *distance).min_by(f64::total_cmp);
    match nearest {
        None if found.margin < WIDE_MARGIN_NATS => NEAR_MARGIN,
        None => WITHOUT_RIVAL,
        Some(distance) if distance >= FAR_RIVAL_NATS => BESIDE_FAR_RIVALS,
        Some(_) if found.rivals.len() == 1 => BESIDE_A_NEAR_RIVAL,
        Some(_) => BESIDE_NEAR_RIVALS,
    }
}

/// What is left of the probability, shared among the rivals by their likelihood.
pub(crate) fn alternatives(found: &Accepted) -> Vec<(EffectId, f64)> {
    let left = 0.97 * (1.0 - probability(found));
    let nearest = found.rivals.iter().map(|(_, distance)| *distance).fold(f64::INFINITY, f64::min);
    let weights: Vec<f64> = found.rivals.iter().map(|(_, distance)| (nearest - distance).exp()).collect();
    let total: f64 = weights.iter().sum();
    found.rivals.iter().zip(&weights).map(|((effect, _), weight)| (*effect, left * weight / total)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::hypotheses::label::Label;

    fn beside(rivals: &[(EffectId, f64)]) -> Accepted {
        Accepted {
            label: Label::Named(EffectId::Spring),
            shape: Vec::new(),
            score: 20.0,
            family_wise: 1e-9,
            fold_gain: Vec::new(),
            margin: 20.0,
            rivals: rivals.to_vec(),
            standings: rivals.to_vec(),
            channels: Vec::new(),
        }
    }

    #[test]
    fn what_is_left_of_the_probability_is_shared_however_far_a_rival_leads() {
        let found = beside(&[(EffectId::GravityError, -2000.0), (EffectId::Contact, -1999.0)]);
        let [first, second] = alternatives(&found)[..] else { panic!() };
        assert!((first.1 + second.1 - 0.97 * (1.0 - probability(&found))).abs() < 1e-12);
        assert!((first.1 / second.1 - 1f64.exp()).abs() < 1e-9);
    }

    #[test]
    fn the_more_rivals_are_near_the_less_is_sure() {
        let near = (EffectId::GravityError, 0.5);
        let stated = [&[][..], &[(EffectId::Contact, 3.0)], &[near], &[near, (EffectId::Contact, 3.0)]]
            .map(|rivals| probability(&beside(rivals)));
        assert!(stated.windows(2).all(|pair| pair[0] > pair[1]), "{stated:?}");
    }
}
