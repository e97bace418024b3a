//! What the search accepted.

use crate::diagnose::hypotheses::channel::Channel;
use crate::diagnose::hypotheses::label::Label;
use crate::physics::{EffectId, Shape};

/// An accepted finding.
#[derive(Clone, Debug)]
pub struct Accepted {
    /// What it is.
    pub label: Label,
    /// Shape parameters.
    pub shape: Shape,
    /// Score in nats when it was accepted.
    pub score: f64,
    /// Family-wise probability under the null when it was accepted.
    pub family_wise: f64,
    /// Held-out gain of each fold in nats.
    pub fold_gain: Vec<f64>,
    /// Margin in nats to the best rival outside the set.
    pub margin: f64,
    /// Named effects within the margin, with their distance in nats.
    pub rivals: Vec<(EffectId, f64)>,
    /// Every other named effect with its distance in nats, nearest first.
    pub standings: Vec<(EffectId, f64)>,
    /// Of a structure without a name: its channel, then those that cannot be told from it. Empty for a named effect.
    pub channels: Vec<Channel>,
    /// Its posterior probability, where the sets were weighed by their likelihood.
    pub stated: Option<Stated>,
}

/// Posterior probability of an effect, and of each that may stand in for it.
#[derive(Clone, Debug)]
pub struct Stated {
    /// Probability that the effect is in the model.
    pub probability: f64,
    /// The others, likeliest first.
    pub alternatives: Vec<(EffectId, f64)>,
}

impl Accepted {
    /// Label and shape, as a candidate's columns are asked for.
    pub(crate) fn term(&self) -> (&Label, &[f64]) {
        (&self.label, &self.shape)
    }

    /// The effect's name: `unknown` for a generic rival.
    pub fn effect(&self) -> EffectId {
        self.label.effect()
    }
}

/// Every accepted effect but one.
pub(crate) fn others(accepted: &[Accepted], without: usize) -> impl Iterator<Item = &Accepted> {
    accepted.iter().enumerate().filter(move |(index, _)| *index != without).map(|(_, found)| found)
}
