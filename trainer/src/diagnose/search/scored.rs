//! A hypothesis with the score that it is compared by.

use crate::diagnose::evidence::score::GroupEvidence;
use crate::diagnose::hypotheses::label::Label;
use crate::physics::{EffectId, Shape};

/// A hypothesis with its score in one round.
#[derive(Clone, Debug)]
pub struct Scored {
    /// What it stands for.
    pub label: Label,
    /// Shape after refinement.
    pub shape: Shape,
    /// Score in nats, by which hypotheses are compared: all by one measure of the noise.
    pub score: f64,
    /// Score in nats by the scatter of its own evidence: whether there is anything.
    pub(crate) own_score: f64,
    /// Family-wise probability under the null; 1 in a round in which nothing reached the least score.
    pub family_wise: f64,
    /// Evidence behind the score.
    pub evidence: GroupEvidence,
    /// Place of the group in the design.
    pub(crate) group: usize,
    /// -log p of its best variant by chi-square.
    pub(crate) surprise: f64,
    /// Energy that its best variant explains before whitening.
    pub(crate) explained: f64,
}

/// Score: the mean of held-out gain and Bayesian criterion; the criterion with a scan penalty for a one-off event, which no other
/// block can confirm. One beyond doubt is weighed as its rivals are: what explains a part of it gains as much where it is held out.
pub(crate) fn score_of(label: &Label, evidence: &GroupEvidence, grid_size: f64) -> f64 {
    let both = 0.5 * (evidence.held_out + evidence.criterion);
    match label {
        Label::Named(EffectId::TransientEvent) => {
            let alone = evidence.criterion - 0.5 * grid_size.ln();
            if alone > CERTAIN_EVENT_NATS { alone.max(both) } else { alone }
        }
        _ => both,
    }
}

/// Criterion of a one-off event above which it is weighed as its rivals are, nats. Chosen by judgement: far beyond the
/// logarithm of the number of windows, some six nats; lower lets an event displace a lasting cause.
const CERTAIN_EVENT_NATS: f64 = 50.0;
