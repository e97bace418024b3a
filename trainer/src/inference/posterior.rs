//! What sets of candidates say together: how probable each candidate is, and what stands in for it where it is not in the model.

use crate::inference::evidence::log_sum_exp;
use crate::inference::sets::{Field, Set};

/// Sets with their probabilities.
#[derive(Clone, Debug)]
pub(crate) struct Posterior {
    /// Sets, likeliest first; nothing is one of them.
    pub sets: Vec<(Set, f64)>,
}

/// Probability below which a stand-in is not told: one in twenty.
const LEAST_TOLD_PROBABILITY: f64 = 0.05;

impl Posterior {
    /// Probabilities of sets of a field, which sum to one.
    pub fn of(field: &Field, sets: Vec<Set>) -> Self {
        let total = log_sum_exp(sets.iter().map(|set| field.weight(set)));
        let sets = sets.into_iter().map(|set| {
            let probability = (field.weight(&set) - total).exp();
            (set, probability)
        });
        Self { sets: sets.collect() }
    }

    /// Probability that the base is all there is.
    pub fn nothing(&self) -> f64 {
        self.sets.iter().filter(|(set, _)| set.members.is_empty()).map(|(_, probability)| probability).sum()
    }

    /// Probability that a candidate is in the model.
    pub fn inclusion(&self, candidate: usize) -> f64 {
        self.sets.iter().filter(|(set, _)| set.holds(candidate)).map(|(_, probability)| probability).sum()
    }

    /// The likeliest set.
    pub fn likeliest(&self) -> Option<&Set> {
        self.sets.first().map(|(set, _)| set)
    }

    /// Candidates that stand in for a member of the likeliest set where it is not in the model, with the probability of each beside
    /// the other members, likeliest first.
    pub fn stand_ins(&self, candidate: usize) -> Vec<(usize, f64)> {
        let Some(likeliest) = self.likeliest() else { return Vec::new() };
        let others: Vec<usize> = likeliest.key().into_iter().filter(|other| *other != candidate).collect();
        let mut found: Vec<(usize, f64)> = Vec::new();
        for (set, probability) in &self.sets {
            if set.holds(candidate) || !others.iter().all(|other| set.holds(*other)) {
                continue;
            }
            for other in set.key().into_iter().filter(|other| !others.contains(other)) {
                match found.iter_mut().find(|(known, _)| *known == other) {
                    Some((_, sum)) => *sum += probability,
                    None => found.push((other, *probability)),
                }
            }
        }
        found.retain(|(_, probability)| *probability >= LEAST_TOLD_PROBABILITY);
        found.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        found
    }
}
