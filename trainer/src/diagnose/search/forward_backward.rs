//! Accepts one effect after the other while the evidence lasts, then cleans up backwards.

use crate::diagnose::evidence::score::GroupEvidence;
use crate::diagnose::hypotheses::label::ridge_of;
use crate::diagnose::noise::autoregression::Noise;
use crate::diagnose::noise::null_draws::NullDraws;
use crate::diagnose::search::accepted::{Accepted, others};
use crate::diagnose::search::round::Round;
use crate::diagnose::search::scored::{Scored, score_of};
use crate::diagnose::search::setup::Search;

/// Largest number of terms, repeated ones included: three of each of the four effects that are accepted at most. A
/// limit of the computing time.
const LARGEST_TERM_COUNT: usize = 12;

/// What the search found.
#[derive(Clone, Debug)]
pub struct SearchOutcome {
    /// Findings in the order in which they were accepted.
    pub accepted: Vec<Accepted>,
    /// Score table of the last round, best first: what was not found.
    pub last_round: Vec<Scored>,
    /// Noise of the last round.
    pub noise: Noise,
}

impl<'a> Search<'a> {
    /// Effects that count towards the largest number of findings: a repeated one counts once.
    fn kinds(accepted: &[Accepted]) -> usize {
        (0..accepted.len()).filter(|&i| accepted[..i].iter().all(|before| before.label != accepted[i].label)).count()
    }

    /// The outcome of a search that was not made: no findings, noise of the base alone.
    pub fn nothing(&self) -> SearchOutcome {
        SearchOutcome {
            accepted: Vec::new(),
            last_round: Vec::new(),
            noise: self.workbench.noise_after(&self.workbench.base.columns),
        }
    }

    /// Runs the search.
    pub fn run(&self) -> SearchOutcome {
        let mut accepted: Vec<Accepted> = Vec::new();
        let mut null = None;
        let mut is_reviewed = false;
        loop {
            let (round, table, finding) = self.next_finding(&accepted, &mut null);
            let is_full = Self::kinds(&accepted) >= self.settings.most_findings || accepted.len() >= LARGEST_TERM_COUNT;
            if let Some(finding) = finding.filter(|_| !is_full) {
                accepted.push(finding);
                continue;
            }
            if is_reviewed || !self.name_beside_the_others(&mut accepted, &mut null) {
                let accepted = self.backward(accepted, &round.noise);
                return SearchOutcome { accepted, last_round: table, noise: round.noise };
            }
            is_reviewed = true;
        }
    }

    /// One round beside the accepted effects: its table of scores, and what it would accept.
    fn next_finding(
        &self,
        accepted: &[Accepted],
        null: &mut Option<NullDraws>,
    ) -> (Round<'_, 'a>, Vec<Scored>, Option<Accepted>) {
        let round = Round::new(self, self.workbench.base_with_tangents(accepted.iter().map(Accepted::term)));
        let mut table = round.score_table(accepted);
        if table.first().is_some_and(|best| best.score > self.settings.candidate_score) {
            // Drawn once: later rounds change the base by a few columns only, and the tails hardly.
            let null = null.get_or_insert_with(|| round.draw_null());
            table.iter_mut().for_each(|scored| scored.family_wise = null.family_wise(scored.group, scored.surprise));
        }
        let finding = round.choose(&table);
        (round, table, finding)
    }

    /// Chooses every structure without a name again, beside all that was found after it: what that took off it may have left what
    /// has a name. Whether any got one.
    fn name_beside_the_others(&self, accepted: &mut [Accepted], null: &mut Option<NullDraws>) -> bool {
        let unnamed: Vec<usize> =
            (0..accepted.len()).filter(|&index| accepted[index].label.channel().is_some()).collect();
        let mut is_any_named = false;
        for index in unnamed {
            // What came last was chosen beside all the others as they stand.
            if index + 1 == accepted.len() && !is_any_named {
                break;
            }
            let beside: Vec<Accepted> = others(accepted, index).cloned().collect();
            let (_, _, chosen) = self.next_finding(&beside, null);
            if let Some(named) = chosen.filter(|found| found.label.channel().is_none()) {
                accepted[index] = named;
                is_any_named = true;
            }
        }
        is_any_named
    }

    /// Whether the open rows alone carry an effect.
    fn is_proved(&self, found: &Accepted) -> bool {
        found.family_wise < self.settings.family_wise_level && found.score > self.settings.least_score
    }

    /// Drops every effect that the others have made superfluous.
    fn backward(&self, mut accepted: Vec<Accepted>, noise: &Noise) -> Vec<Accepted> {
        while accepted.len() > 1 {
            let superfluous = (0..accepted.len()).filter(|&index| {
                // What only the locked rows can still confirm displaces nothing that the open rows have proved.
                // Nor does a structure without a name displace a name: that was kept beside it when it came.
                let is_named = |found: &Accepted| found.label.channel().is_none();
                let counts = |other: &Accepted| {
                    (self.is_proved(other) || !self.is_proved(&accepted[index]))
                        && (is_named(other) || !is_named(&accepted[index]))
                };
                let bench = self.workbench.bench(
                    self.workbench
                        .base_with_tangents(others(&accepted, index).filter(|other| counts(other)).map(Accepted::term)),
                    noise,
                );
                let mut columns = self
                    .workbench
                    .whitened(&self.workbench.filtered_columns(&accepted[index].label, &accepted[index].shape), noise);
                let ridge = ridge_of(&accepted[index].label, &accepted[index].shape);
                if ridge.is_empty() {
                    // Of a series the others may hold one term, which says nothing of the rest.
                    bench.retain_independent(&mut columns);
                }
                let gain = bench
                    .alone()
                    .zip(bench.weigh(&columns, &ridge, true))
                    .and_then(|(alone, evidence)| GroupEvidence::weigh(&alone, &[Some(evidence)], bench.rows(), 1.0));
                let score = gain.map_or(f64::NEG_INFINITY, |gain| score_of(&accepted[index].label, &gain, 1.0));
                score < self.settings.least_score
            });
            // Of two that make each other superfluous the one goes that had less in its favour when it came.
            match superfluous.min_by(|&a, &b| accepted[a].score.total_cmp(&accepted[b].score)) {
                Some(index) => {
                    accepted.remove(index);
                }
                None => break,
            }
        }
        accepted
    }
}
