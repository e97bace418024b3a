//! What the open rows show and the locked rows bear out.

use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::infer::inferred::Inferred;
use crate::diagnose::noise::autoregression::Noise;
use crate::diagnose::proof::discarded::withdraw_unproven;
use crate::diagnose::proof::refit::{Refit, polish};
use crate::diagnose::search::accepted::Accepted;
use crate::diagnose::search::forward_backward::SearchOutcome;
use crate::diagnose::search::scored::Scored;
use crate::diagnose::search::setup::Search;
use crate::physics::EffectId;

/// Searches of one recording at most. A limit of the computing time: two functions of one channel may stand in for each other.
const MOST_SEARCHES: usize = 3;

/// What a search found and the locked rows bear out.
pub(crate) struct Confirmed {
    /// Effects that stay.
    pub accepted: Vec<Accepted>,
    /// Effects that do not.
    pub withdrawn: Vec<EffectId>,
    /// Effects that are too small to be named, with their torque (root mean square).
    pub negligible: Vec<(EffectId, f64)>,
    /// Table of scores of the last round.
    pub last_round: Vec<Scored>,
    /// Noise of the last round.
    pub noise: Noise,
}

impl Confirmed {
    /// Of a search that was not made.
    pub fn nothing(search: &Search) -> Self {
        let SearchOutcome { accepted, last_round, noise } = search.nothing();
        Self { accepted, withdrawn: Vec::new(), negligible: Vec::new(), last_round, noise }
    }

    /// What the likeliest set says of effects that are large enough.
    pub fn by_likelihood(inferred: &Inferred) -> Self {
        let (accepted, negligible) = inferred.accepted();
        let noise = inferred.noise.clone();
        Self { accepted, withdrawn: Vec::new(), negligible, last_round: inferred.table(), noise }
    }

    /// Searches, and again without the structures that have no name where the locked rows bear out nothing at all: a function of one channel
    /// may have taken up what effects with a name explain.
    pub fn of(search: &mut Search, baseline: &Refit) -> Self {
        let workbench: &Workbench = search.workbench;
        let mut withdrawn = Vec::new();
        let mut searches_left = MOST_SEARCHES;
        loop {
            searches_left -= 1;
            let SearchOutcome { mut accepted, last_round, noise } = search.run();
            polish(workbench, &mut accepted, &noise);
            let labels = accepted.iter().map(|found| found.label.clone());
            let unnamed: Vec<Label> = labels.filter(|label| label.channel().is_some()).collect();
            withdrawn.extend(withdraw_unproven(workbench, &search.settings, baseline, &mut accepted));
            if !accepted.is_empty() || unnamed.is_empty() || searches_left == 0 {
                return Self { accepted, withdrawn, negligible: Vec::new(), last_round, noise };
            }
            search.refused.extend(unnamed);
        }
    }
}
