//! Accepts one effect after the other while the evidence lasts, then cleans up backwards.

use crate::diagnose::comparison::base::{Base, Delay};
use crate::diagnose::evidence::law_uncertainty::Doubt;
use crate::diagnose::evidence::score::{Bench, GroupEvidence};
use crate::diagnose::hypotheses::channel::Channel;
use crate::diagnose::hypotheses::design::{Design, Label, ridge_of};
use crate::diagnose::noise::autoregression::{Noise, noise_features};
use crate::diagnose::noise::null_draws::NullDraws;
use crate::diagnose::preparation::prepare::Prepared;
use crate::diagnose::proof::refit::Fitted;
use crate::diagnose::search::round::{Round, Scored, score_of};
use crate::diagnose::search::thresholds::Settings;
use crate::numerics::least_squares::{left_by_fit, weighted};
use crate::physics::{EffectId, Hypothesis, JointState, Shape};
use rayon::prelude::*;

/// Terms at most, repeated ones included.
const MOST_TERMS: usize = 12;

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
}

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

/// The search over one prepared recording.
pub struct Search<'a> {
    pub(crate) prepared: &'a Prepared,
    pub(crate) base: &'a Base,
    pub(crate) design: Design,
    pub(crate) hypotheses: &'a [Box<dyn Hypothesis + Send>],
    pub(crate) settings: Settings,
    features: Vec<Vec<f64>>,
}

impl<'a> Search<'a> {
    /// Builds the design of every hypothesis that the recording can show.
    pub fn new(
        prepared: &'a Prepared,
        base: &'a Base,
        hypotheses: &'a [Box<dyn Hypothesis + Send>],
        settings: Settings,
    ) -> Self {
        let left_out: &[EffectId] = if base.delay == Delay::Open { &[] } else { &[EffectId::TimeMisalignment] };
        let design = Design::new(prepared, hypotheses, left_out);
        let features = noise_features(prepared);
        Self { prepared, base, design, hypotheses, settings, features }
    }

    /// Whether a label may be found in the next round: once, except for effects that repeat with other shapes.
    pub(crate) fn may_be_found(&self, label: &Label, accepted: &[Accepted]) -> bool {
        let repeats = match label {
            Label::Named(effect) => self.hypothesis(*effect).is_some_and(Hypothesis::repeats),
            Label::Generic(_) => false,
        };
        repeats || accepted.iter().all(|found| found.label != *label)
    }

    /// Effects that count towards the largest number of findings: a repeated one counts once.
    fn kinds(accepted: &[Accepted]) -> usize {
        (0..accepted.len()).filter(|&i| accepted[..i].iter().all(|before| before.label != accepted[i].label)).count()
    }

    /// Shapes that a group was allowed to choose from.
    pub(crate) fn grid_size(&self, group: usize) -> f64 {
        let group = &self.design.groups[group];
        let scanned = match group.label {
            Label::Named(effect) => self.hypothesis(effect).and_then(|h| h.scanned(&self.prepared.state)),
            Label::Generic(_) => None,
        };
        scanned.unwrap_or(group.variants.len() as f64)
    }

    /// Nats that a group's surprise loses to the shapes that were scanned and not proposed: the null draws do not know them.
    pub(crate) fn scanned_beyond(&self, group: usize) -> f64 {
        (self.grid_size(group) / self.design.groups[group].variants.len() as f64).ln()
    }

    /// The hypothesis of an effect.
    pub(crate) fn hypothesis(&self, effect: EffectId) -> Option<&dyn Hypothesis> {
        self.hypotheses.iter().find(|h| h.id() == effect).map(|h| h.as_ref() as &dyn Hypothesis)
    }

    /// Whether the coefficients of a label may only be positive, because the effect cannot turn its sign. The recording may have
    /// less of what a reference holds, under whichever name.
    pub(crate) fn only_positive(&self, label: &Label) -> bool {
        match label {
            Label::Named(effect) => {
                self.base.held.is_empty() && self.hypothesis(*effect).is_some_and(Hypothesis::only_positive)
            }
            Label::Generic(_) => false,
        }
    }

    /// Whether a label can have these coefficients.
    pub(crate) fn is_possible(&self, label: &Label, coefficients: &[f64]) -> bool {
        !self.only_positive(label) || coefficients.iter().all(|c| *c > 0.0)
    }

    /// Unfiltered columns of a label and shape at states of the rows.
    fn raw_columns(&self, state: &JointState, label: &Label, shape: &[f64]) -> Vec<Vec<f64>> {
        match label {
            Label::Named(effect) => self.hypothesis(*effect).map(|h| h.columns(state, shape)).unwrap_or_default(),
            Label::Generic(rival) => rival.columns(state, shape),
        }
    }

    /// Filtered columns of a label and shape.
    pub(crate) fn filtered_columns(&self, label: &Label, shape: &[f64]) -> Vec<Vec<f64>> {
        self.filtered_columns_at(&self.prepared.state, label, shape)
    }

    /// The same at other states of the rows.
    pub(crate) fn filtered_columns_at(&self, state: &JointState, label: &Label, shape: &[f64]) -> Vec<Vec<f64>> {
        self.prepared.filtered_all(&self.raw_columns(state, label, shape))
    }

    /// The outcome of a search that was not made: no findings, noise of the base alone.
    pub fn nothing(&self) -> SearchOutcome {
        SearchOutcome { accepted: Vec::new(), last_round: Vec::new(), noise: self.noise_after(&self.base.columns) }
    }

    /// Runs the search.
    pub fn run(&self) -> SearchOutcome {
        let mut accepted: Vec<Accepted> = Vec::new();
        let mut null = None;
        let mut is_reviewed = false;
        loop {
            let (round, table, finding) = self.next_finding(&accepted, &mut null);
            let is_full = Self::kinds(&accepted) >= self.settings.most_findings || accepted.len() >= MOST_TERMS;
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
        let round = Round::new(self, self.base_with(accepted));
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

    /// Filtered columns of the base and of the accepted effects with their tangents.
    pub(crate) fn base_with<'f>(&self, accepted: impl IntoIterator<Item = &'f Accepted>) -> Vec<Vec<f64>> {
        let mut columns = self.base.columns.clone();
        for effect in accepted {
            columns.extend(self.filtered_columns(&effect.label, &effect.shape));
            let tangents = self.column_tangents(&effect.label, &effect.shape);
            columns.extend(tangents.into_iter().flat_map(|(_, columns)| columns));
        }
        columns
    }

    /// Change of every filtered column with each refinable shape parameter, with the place of that parameter.
    pub(crate) fn column_tangents(&self, label: &Label, shape: &[f64]) -> Vec<(usize, Vec<Vec<f64>>)> {
        let Label::Named(effect) = label else { return Vec::new() };
        let Some(hypothesis) = self.hypothesis(*effect) else { return Vec::new() };
        let state = &self.prepared.state;
        let free = (0..shape.len()).filter(|&index| hypothesis.bounds(state, index, shape).is_some());
        free.map(|index| {
            let step = 0.05 * hypothesis.step(state, index, shape);
            let shifted = |by: f64| {
                let mut moved = shape.to_vec();
                moved[index] += by;
                self.filtered_columns(label, &moved)
            };
            let difference = |(up, down): (Vec<f64>, Vec<f64>)| -> Vec<f64> {
                up.iter().zip(&down).map(|(u, d)| (u - d) / (2.0 * step)).collect()
            };
            (index, shifted(step).into_iter().zip(shifted(-step)).map(difference).collect())
        })
        .collect()
    }

    /// Filtered torque of a fitted effect at every working row.
    pub(crate) fn torque_of(&self, fitted: &Fitted) -> Vec<f64> {
        weighted(&self.filtered_columns(&fitted.label, &fitted.shape), &fitted.coefficients)
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
                let counts = |other: &Accepted| self.is_proved(other) || !self.is_proved(&accepted[index]);
                let bench = self.bench(self.base_with(others(&accepted, index).filter(|other| counts(other))), noise);
                let mut columns =
                    self.whitened(&self.filtered_columns(&accepted[index].label, &accepted[index].shape), noise);
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

    pub(crate) fn whitened(&self, columns: &[Vec<f64>], noise: &Noise) -> Vec<Vec<f64>> {
        let runs = self.prepared.open_runs();
        columns.par_iter().map(|column| noise.whitened(column, &runs)).collect()
    }

    pub(crate) fn bench(&self, base: Vec<Vec<f64>>, noise: &Noise) -> Bench {
        let blocks =
            self.prepared.blocks.iter().filter(|block| !block.locked).map(|block| block.runs.clone()).collect();
        let target = self.whitened(std::slice::from_ref(&self.base.target), noise).swap_remove(0);
        Bench::new(self.whitened(&base, noise), target, blocks)
    }

    /// Doubts of the reference beside the base of a bench.
    pub(crate) fn doubt(&self, bench: &Bench, noise: &Noise) -> Doubt {
        Doubt::beside(&bench.base, self.whitened(&self.base.doubt, noise), bench.runs())
    }

    /// Noise of what the columns leave after an ordinary least-squares fit: one that is whitened first may leave slow
    /// errors that pass for noise.
    pub(crate) fn noise_after(&self, columns: &[Vec<f64>]) -> Noise {
        let runs = self.prepared.open_runs();
        let left = left_by_fit(columns, &self.base.target, &runs);
        Noise::fit(left.as_ref().unwrap_or(&self.base.target), &runs, &self.features)
    }
}

/// Every accepted effect but one.
pub(crate) fn others(accepted: &[Accepted], without: usize) -> impl Iterator<Item = &Accepted> {
    accepted.iter().enumerate().filter(move |(index, _)| *index != without).map(|(_, found)| found)
}

impl Accepted {
    /// The effect's name: `unknown` for a generic rival.
    pub fn effect(&self) -> EffectId {
        self.label.effect()
    }
}
