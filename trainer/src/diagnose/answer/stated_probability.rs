//! Stated probabilities: how often a name with this margin and set turned out right on the simulated suite (seeds 62000 and 64000 of
//! `cargo run --release -p frikan-tests --bin concealed-suite`), and how much less where joints of another simulator disagree.

use crate::diagnose::search::accepted::Accepted;
use crate::physics::EffectId;

/// Frequencies of a right first name by its margin and its rivals, with the limits between the cases.
struct Frequencies {
    /// Without a rival, where the next name is [`Self::margin_nats`] away or more.
    alone: f64,
    /// Without a rival, where the next name is closer.
    near_margin: f64,
    /// Beside rivals of which the nearest is [`Self::rival_nats`] away or more.
    far_rivals: f64,
    /// Beside one nearer rival.
    near_rival: f64,
    /// Beside several of which one is nearer.
    near_rivals: f64,
    /// Margin in nats from which a name without a rival was hardly ever wrong.
    margin_nats: f64,
    /// Distance in nats from which a rival was seldom the truth.
    rival_nats: f64,
}

/// As counted on some five hundred concealed effects of the seeds above.
const FREQUENCIES: Frequencies = Frequencies {
    alone: 0.98,
    near_margin: 0.95,
    far_rivals: 0.8,
    near_rival: 0.75,
    near_rivals: 0.5,
    margin_nats: 6.0,
    rival_nats: 1.5,
};

/// Probability of what has no rival by its nature: a wrong level of a reference, whose change is linear in it, and an event that
/// leaves one stretch with several times the error of any other.
pub(crate) const WITHOUT_RIVAL: f64 = FREQUENCIES.alone;

/// Most that is stated of a name of which held-out rows do not show by their interval that the error falls with it: as of one with a rival
/// far behind.
pub(crate) const WITHOUT_SHOWN_GAIN: f64 = FREQUENCIES.far_rivals;

/// Most that is stated of a one-off event, which no other rows can confirm, of a structure without a name, and of what was found beside
/// another effect, whose formula may err by as much. On joints of MuJoCo with one effect (`foreign_pairs.py --only effects`, seeds 27021
/// and 27051) 4 of 15, 0 of 9 and 1 of 18 of them are true, in the suite above nearly all: the middle, since a recording does not
/// tell to which it belongs.
const SELDOM_CONFIRMED: f64 = 0.5;

/// Probability that the named effect is the true one, by its margin and its rivals; `is_first` where it was found before all others.
pub(crate) fn probability(found: &Accepted, is_first: bool) -> f64 {
    if let Some(stated) = &found.stated {
        return stated.probability;
    }
    let is_seldom_true = !is_first || matches!(found.effect(), EffectId::TransientEvent | EffectId::Unknown);
    by_rivals(found).min(if is_seldom_true { SELDOM_CONFIRMED } else { 1.0 })
}

/// How often a name with this margin and these rivals is right in the suite.
fn by_rivals(found: &Accepted) -> f64 {
    let nearest = found.rivals.iter().map(|(_, distance)| *distance).min_by(f64::total_cmp);
    match nearest {
        None if found.margin < FREQUENCIES.margin_nats => FREQUENCIES.near_margin,
        None => FREQUENCIES.alone,
        Some(distance) if distance >= FREQUENCIES.rival_nats => FREQUENCIES.far_rivals,
        Some(_) if found.rivals.len() == 1 => FREQUENCIES.near_rival,
        Some(_) => FREQUENCIES.near_rivals,
    }
}

/// What is left of the probability by the rivals, shared among them by their likelihood.
pub(crate) fn alternatives(found: &Accepted) -> Vec<(EffectId, f64)> {
    if let Some(stated) = &found.stated {
        return stated.alternatives.clone();
    }
    let left = 0.97 * (1.0 - by_rivals(found));
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
            stated: None,
        }
    }

    #[test]
    fn what_is_left_of_the_probability_is_shared_however_far_a_rival_leads() {
        let found = beside(&[(EffectId::GravityError, -2000.0), (EffectId::Contact, -1999.0)]);
        let [first, second] = alternatives(&found)[..] else { panic!() };
        assert!((first.1 + second.1 - 0.97 * (1.0 - probability(&found, true))).abs() < 1e-12);
        assert!((first.1 / second.1 - 1f64.exp()).abs() < 1e-9);
    }

    #[test]
    fn what_little_confirms_is_stated_as_uncertain() {
        let event = Accepted { label: Label::Named(EffectId::TransientEvent), ..beside(&[]) };
        assert_eq!(probability(&beside(&[]), true), 0.98);
        assert_eq!([probability(&event, true), probability(&beside(&[]), false)], [0.5, 0.5]);
    }

    #[test]
    fn the_more_rivals_are_near_the_less_is_sure() {
        let near = (EffectId::GravityError, 0.5);
        let stated = [&[][..], &[(EffectId::Contact, 3.0)], &[near], &[near, (EffectId::Contact, 3.0)]]
            .map(|rivals| probability(&beside(rivals), true));
        assert!(stated.windows(2).all(|pair| pair[0] > pair[1]), "{stated:?}");
    }
}
