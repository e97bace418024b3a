//! Accepts one effect after the other while the evidence lasts, then cleans up backwards.

use super::base::Base;
use super::candidates::{Design, Generic, Label, generic_columns};
use super::evidence::{Bench, GroupEvidence, VariantEvidence};
use super::linear::{orthonormal, project_out, residual};
use super::noise::Noise;
use super::null::{Directions, NullDraws, chi_square_surprise};
use super::prepare::Prepared;
use super::refine::refine;
use crate::physics::{EffectId, Hypothesis, Shape};
use rayon::prelude::*;
use std::ops::Range;

/// Limits of the search; fixed on one set of seeds and reported on another.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Family-wise probability below which an effect is a finding.
    pub family_wise_level: f64,
    /// Least score in nats.
    pub least_score: f64,
    /// Margin in nats within which rivals cannot be told apart.
    pub ambiguity_margin: f64,
    /// Null draws a round.
    pub null_draws: usize,
    /// Largest number of accepted effects.
    pub most_findings: usize,
    /// Seed of the null draws.
    pub seed: u64,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            family_wise_level: 0.01,
            least_score: 3.0,
            ambiguity_margin: 3.0,
            null_draws: 200,
            most_findings: 4,
            seed: 0,
        }
    }
}

/// Share of a free function's explained energy at which a name is good enough.
const NEARLY_AS_MUCH: f64 = 0.9;

/// Terms at most, repeated ones included.
const MOST_TERMS: usize = 12;

/// A hypothesis with its score in one round.
#[derive(Clone, Debug)]
pub struct Scored {
    /// What it stands for.
    pub label: Label,
    /// Shape after refinement.
    pub shape: Shape,
    /// Score in nats.
    pub score: f64,
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

/// An accepted finding.
#[derive(Clone, Debug)]
pub struct Accepted {
    /// What it is.
    pub label: Label,
    /// Shape parameters.
    pub shape: Shape,
    /// Score, probability and evidence when it was accepted.
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
        let left_out: &[EffectId] = if base.delay_is_nuisance { &[EffectId::TimeMisalignment] } else { &[] };
        let design = Design::new(prepared, hypotheses, left_out);
        let features = noise_features(prepared);
        Self { prepared, base, design, hypotheses, settings, features }
    }

    /// Whether a label may be found in the next round: once, except for effects that repeat with other shapes.
    fn may_be_found(&self, label: &Label, accepted: &[Accepted]) -> bool {
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
    fn grid_size(&self, group: usize) -> f64 {
        let group = &self.design.groups[group];
        let scanned = match group.label {
            Label::Named(effect) => self.hypothesis(effect).and_then(|h| h.scanned(&self.prepared.state)),
            Label::Generic(_) => None,
        };
        scanned.unwrap_or(group.variants.len() as f64)
    }

    /// The hypothesis of an effect.
    pub(crate) fn hypothesis(&self, effect: EffectId) -> Option<&dyn Hypothesis> {
        self.hypotheses.iter().find(|h| h.id() == effect).map(|h| h.as_ref() as &dyn Hypothesis)
    }

    /// Unfiltered columns of a label and shape.
    pub(crate) fn raw_columns(&self, label: &Label, shape: &[f64]) -> Vec<Vec<f64>> {
        match label {
            Label::Named(effect) => {
                self.hypothesis(*effect).map(|h| h.columns(&self.prepared.state, shape)).unwrap_or_default()
            }
            Label::Generic(rival) => generic_columns(&self.prepared.state, *rival, shape[0] as usize),
        }
    }

    /// Filtered columns of a label and shape.
    pub(crate) fn filtered_columns(&self, label: &Label, shape: &[f64]) -> Vec<Vec<f64>> {
        self.raw_columns(label, shape).iter().map(|raw| self.prepared.filtered(raw)).collect()
    }

    /// The outcome of a search that was not made: no findings, noise of the base alone.
    pub fn nothing(&self) -> SearchOutcome {
        SearchOutcome { accepted: Vec::new(), last_round: Vec::new(), noise: self.noise_after(&self.base.columns) }
    }

    /// Runs the search.
    pub fn run(&self) -> SearchOutcome {
        let mut accepted: Vec<Accepted> = Vec::new();
        let mut null = None;
        let (low, high) = self.prepared.state.travel();
        let travel = high - low;
        loop {
            let round = Round::new(self, self.base_with(&accepted, None));
            let mut table = round.score_table(&accepted);
            if table.first().is_some_and(|best| best.score > self.settings.least_score) {
                // Drawn once: later rounds change the base by a few columns only, and the tails hardly.
                let null = null.get_or_insert_with(|| round.draw_null());
                table
                    .iter_mut()
                    .for_each(|scored| scored.family_wise = null.family_wise(scored.group, scored.surprise));
            }
            let finding = choose(&table, &self.settings, travel);
            match finding {
                Some(finding)
                    if Self::kinds(&accepted) < self.settings.most_findings && accepted.len() < MOST_TERMS =>
                {
                    accepted.push(finding);
                }
                _ => {
                    let accepted = self.backward(accepted, &round.noise);
                    return SearchOutcome { accepted, last_round: table, noise: round.noise };
                }
            }
        }
    }

    /// Filtered columns of the base and of the accepted effects with their tangents, but not those of `without`.
    pub(crate) fn base_with(&self, accepted: &[Accepted], without: Option<usize>) -> Vec<Vec<f64>> {
        let mut columns = self.base.columns.clone();
        for (index, effect) in accepted.iter().enumerate() {
            if Some(index) != without {
                columns.extend(self.filtered_columns(&effect.label, &effect.shape));
                columns.extend(self.tangents(&effect.label, &effect.shape));
            }
        }
        columns
    }

    /// Change of the filtered columns with each refinable shape parameter, summed per coefficient by their own columns:
    /// one column a coefficient and shape parameter.
    pub(crate) fn tangents(&self, label: &Label, shape: &[f64]) -> Vec<Vec<f64>> {
        let Label::Named(effect) = label else { return Vec::new() };
        let Some(hypothesis) = self.hypothesis(*effect) else { return Vec::new() };
        let state = &self.prepared.state;
        let mut tangents = Vec::new();
        for index in 0..shape.len() {
            if hypothesis.bounds(state, index, shape).is_none() {
                continue;
            }
            let step = 0.05 * hypothesis.step(state, index, shape);
            let shifted = |by: f64| {
                let mut moved = shape.to_vec();
                moved[index] += by;
                self.filtered_columns(label, &moved)
            };
            for (up, down) in shifted(step).into_iter().zip(shifted(-step)) {
                tangents.push(up.iter().zip(&down).map(|(u, d)| (u - d) / (2.0 * step)).collect());
            }
        }
        tangents
    }

    /// Drops every effect that the others have made superfluous.
    fn backward(&self, mut accepted: Vec<Accepted>, noise: &Noise) -> Vec<Accepted> {
        while accepted.len() > 1 {
            let weakest = (0..accepted.len())
                .map(|index| {
                    let bench = self.bench(self.base_with(&accepted, Some(index)), noise);
                    let columns =
                        self.whitened(&self.filtered_columns(&accepted[index].label, &accepted[index].shape), noise);
                    let gain = bench.alone().zip(bench.evidence(&columns)).and_then(|(alone, evidence)| {
                        GroupEvidence::weigh(&alone, &[Some(evidence)], bench.rows(), 1.0)
                    });
                    (index, gain.map_or(f64::NEG_INFINITY, |g| score_of(&accepted[index].label, &g, 1.0)))
                })
                .min_by(|a, b| a.1.total_cmp(&b.1));
            match weakest {
                Some((index, score)) if score < self.settings.least_score => {
                    accepted.remove(index);
                }
                _ => break,
            }
        }
        accepted
    }

    pub(crate) fn whitened(&self, columns: &[Vec<f64>], noise: &Noise) -> Vec<Vec<f64>> {
        let runs = self.prepared.open_runs();
        columns
            .par_iter()
            .map(|column| {
                let mut white = column.clone();
                noise.whiten(&mut white, &runs);
                white
            })
            .collect()
    }

    pub(crate) fn bench(&self, base: Vec<Vec<f64>>, noise: &Noise) -> Bench {
        let order = noise.autoregression.len();
        let blocks = self
            .prepared
            .blocks
            .iter()
            .filter(|block| !block.locked)
            .map(|block| {
                block
                    .runs
                    .iter()
                    .map(|run| (run.start + order).min(run.end)..run.end)
                    .filter(|r| !r.is_empty())
                    .collect()
            })
            .filter(|runs: &Vec<Range<usize>>| !runs.is_empty())
            .collect();
        let target = self.whitened(std::slice::from_ref(&self.base.target), noise).swap_remove(0);
        Bench::new(self.whitened(&base, noise), target, blocks)
    }

    /// Noise of what the columns leave after an ordinary least-squares fit: one that is whitened first may leave slow
    /// errors that pass for noise.
    pub(crate) fn noise_after(&self, columns: &[Vec<f64>]) -> Noise {
        let runs = self.prepared.open_runs();
        let rest = match super::linear::least_squares(columns, &self.base.target, &runs) {
            Some(coefficients) => residual(columns, &self.base.target, &coefficients),
            None => self.base.target.clone(),
        };
        Noise::fit(&rest, &runs, &self.features)
    }
}

/// What the variance of the noise may depend on: |v|, |a| and nearness to standstill, each scaled to order one.
fn noise_features(prepared: &Prepared) -> Vec<Vec<f64>> {
    let state = &prepared.state;
    let scaled = |series: Vec<f64>| {
        let mean = series.iter().sum::<f64>() / series.len().max(1) as f64;
        series.iter().map(|v| (v / mean.max(f64::MIN_POSITIVE)).min(5.0)).collect::<Vec<f64>>()
    };
    let slow = (0.05 * state.top_speed()).max(3.0 * state.sign_velocity);
    vec![
        scaled(prepared.rows.iter().map(|&i| state.velocity[i].abs()).collect()),
        scaled(prepared.rows.iter().map(|&i| state.acceleration[i].abs()).collect()),
        prepared.rows.iter().map(|&i| (-(state.velocity[i] / slow).powi(2)).exp()).collect(),
    ]
}

/// Score: the mean of held-out gain and Bayesian criterion for a named effect; held-out gain for a generic rival;
/// the criterion with a scan penalty for a one-off event, which no other block can confirm.
pub(crate) fn score_of(label: &Label, evidence: &GroupEvidence, grid_size: f64) -> f64 {
    match label {
        Label::Named(EffectId::TransientEvent) => evidence.criterion - 0.5 * grid_size.ln(),
        Label::Named(_) => 0.5 * (evidence.held_out + evidence.criterion),
        Label::Generic(_) => evidence.held_out,
    }
}

/// Evidence of every variant of every group; `None` where a variant depends on the base.
type Tested = Vec<Vec<Option<VariantEvidence>>>;

struct Round<'s, 'a> {
    search: &'s Search<'a>,
    noise: Noise,
    bench: Bench,
    alone: Option<VariantEvidence>,
    variants: Tested,
    white: Vec<Vec<f64>>,
    /// Largest energy that each group explains before whitening.
    explained: Vec<f64>,
}

impl<'s, 'a> Round<'s, 'a> {
    fn new(search: &'s Search<'a>, base: Vec<Vec<f64>>) -> Self {
        // Noise from the base and the two best candidates: from the bare base the effect would pass for noise, and a slow
        // effect for colour. So the first candidates are chosen as if the noise were white.
        let mut noise = Noise::white(search.prepared.rows.len());
        let mut explained = Vec::new();
        for _ in 0..2 {
            let (_, bench, variants) = weigh_all(search, base.clone(), &noise, false);
            if explained.is_empty() {
                let largest = |tested: &Vec<Option<VariantEvidence>>| {
                    tested.iter().flatten().map(|v| v.statistic).fold(0.0, f64::max)
                };
                explained = variants.iter().map(largest).collect();
            }
            let mut generous = base.clone();
            generous.extend(best_two(search, &bench, &variants));
            noise = search.noise_after(&generous);
        }
        let (white, bench, variants) = weigh_all(search, base, &noise, true);
        let alone = bench.alone();
        Self { search, noise, bench, alone, variants, white, explained }
    }

    fn draw_null(&self) -> NullDraws {
        let best = best_two(self.search, &self.bench, &self.variants);
        draw_null(self.search, &self.bench, &self.white, &self.variants, &self.search.whitened(&best, &self.noise))
    }

    fn score_table(&self, accepted: &[Accepted]) -> Vec<Scored> {
        let Some(alone) = &self.alone else { return Vec::new() };
        let rows = self.bench.rows();
        let mut table: Vec<Scored> = self
            .search
            .design
            .groups
            .iter()
            .enumerate()
            .filter(|(_, group)| self.search.may_be_found(&group.label, accepted))
            .filter_map(|(index, group)| {
                let grid = self.search.grid_size(index);
                let evidence = GroupEvidence::weigh(alone, &self.admissible(index), rows, grid)?;
                let surprise = self.variants[index]
                    .iter()
                    .flatten()
                    .map(|v| chi_square_surprise(v.statistic, v.degrees))
                    .fold(0.0, f64::max);
                Some(Scored {
                    label: group.label.clone(),
                    shape: group.variants[evidence.best].shape.clone(),
                    score: score_of(&group.label, &evidence, grid),
                    family_wise: 1.0,
                    evidence,
                    group: index,
                    surprise,
                    explained: self.explained[index],
                })
            })
            .collect();
        self.refine_leaders(&mut table, alone, rows);
        table.sort_by(|a, b| b.score.total_cmp(&a.score));
        table
    }

    /// The variants of a group whose coefficients have a possible sign.
    fn admissible(&self, group: usize) -> Vec<Option<VariantEvidence>> {
        let positive = match self.search.design.groups[group].label {
            Label::Named(effect) => self.search.hypothesis(effect).is_some_and(Hypothesis::only_positive),
            Label::Generic(_) => false,
        };
        let possible = |e: &VariantEvidence| !positive || e.coefficients.iter().all(|c| *c > 0.0);
        self.variants[group].iter().map(|variant| variant.clone().filter(possible)).collect()
    }

    /// Refines the shapes of the leading named effects, so that no rival loses by the coarseness of its grid.
    fn refine_leaders(&self, table: &mut [Scored], alone: &VariantEvidence, rows: f64) {
        const REFINED_WITHIN_NATS: f64 = 15.0;
        let named = table.iter().filter(|s| matches!(s.label, Label::Named(_)));
        let lead = named.map(|s| s.score).fold(f64::NEG_INFINITY, f64::max);
        let threshold = (lead - REFINED_WITHIN_NATS).max(0.0);
        table.par_iter_mut().for_each(|scored| {
            let Label::Named(effect) = scored.label else { return };
            let Some(hypothesis) = self.search.hypothesis(effect) else { return };
            if scored.score < threshold {
                return;
            }
            let state = &self.search.prepared.state;
            let weigh = |shape: &[f64]| {
                let columns = self.search.filtered_columns(&scored.label, shape);
                self.bench.evidence(&self.search.whitened(&columns, &self.noise))
            };
            let positive = hypothesis.only_positive();
            let weigh = |shape: &[f64]| weigh(shape).filter(|e| !positive || e.coefficients.iter().all(|c| *c > 0.0));
            let shape = refine(hypothesis, state, &scored.shape, |shape| weigh(shape).map(|e| e.statistic));
            let grid = self.search.grid_size(scored.group);
            if let Some(evidence) = GroupEvidence::weigh(alone, &[weigh(&shape)], rows, grid) {
                let score = score_of(&scored.label, &evidence, grid);
                if score > scored.score {
                    scored.shape = shape;
                    scored.score = score;
                    scored.evidence = evidence;
                }
            }
        });
    }
}

/// Whitens the design and weighs every variant, held-out folds only where asked for.
fn weigh_all(search: &Search, base: Vec<Vec<f64>>, noise: &Noise, folds: bool) -> (Vec<Vec<f64>>, Bench, Tested) {
    let bench = search.bench(base, noise);
    let white = search.whitened(&search.design.columns, noise);
    let variants = search
        .design
        .groups
        .par_iter()
        .map(|group| group.variants.iter().map(|variant| bench.weigh(&white[variant.columns.clone()], folds)).collect())
        .collect();
    (white, bench, variants)
}

/// Unwhitened columns of the two groups whose best variants surprise most.
fn best_two(search: &Search, bench: &Bench, variants: &[Vec<Option<VariantEvidence>>]) -> Vec<Vec<f64>> {
    let rows = bench.rows();
    let mut gains: Vec<(f64, usize, usize)> = Vec::new();
    for (group, tested) in variants.iter().enumerate() {
        let best = tested
            .iter()
            .enumerate()
            .filter_map(|(i, v)| v.as_ref().map(|v| (v.statistic - v.degrees as f64 * rows.ln(), i)))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((gain, variant)) = best {
            gains.push((gain, group, variant));
        }
    }
    gains.sort_by(|a, b| b.0.total_cmp(&a.0));
    gains
        .iter()
        .take(2)
        .flat_map(|(_, group, variant)| {
            search.design.columns[search.design.groups[*group].variants[*variant].columns.clone()].to_vec()
        })
        .collect()
}

fn draw_null(
    search: &Search,
    bench: &Bench,
    white: &[Vec<f64>],
    variants: &[Vec<Option<VariantEvidence>>],
    best: &[Vec<f64>],
) -> NullDraws {
    let runs = bench.runs();
    let base_directions = orthonormal(&bench.base, &runs);
    let directions: Directions = search
        .design
        .groups
        .par_iter()
        .zip(variants)
        .map(|(group, tested)| {
            group
                .variants
                .iter()
                .zip(tested)
                .filter(|(_, evidence)| evidence.is_some())
                .map(|(variant, _)| {
                    let mut columns = white[variant.columns.clone()].to_vec();
                    columns.iter_mut().for_each(|column| project_out(column, &base_directions, &runs));
                    orthonormal(&columns, &runs)
                })
                .collect()
        })
        .collect();
    let mut rest = bench.target.clone();
    project_out(&mut rest, &base_directions, &runs);
    let mut extended = base_directions.clone();
    extended.extend(best.to_vec());
    project_out(&mut rest, &orthonormal(&extended, &runs), &runs);
    NullDraws::draw(&directions, &base_directions, &rest, &runs, search.settings.null_draws, search.settings.seed)
}

/// Decides a round: the best passing hypothesis with its ambiguity set, or nothing.
fn choose(table: &[Scored], settings: &Settings, travel: f64) -> Option<Accepted> {
    let passes = |s: &&Scored| s.family_wise < settings.family_wise_level && s.score > settings.least_score;
    let is_named = |s: &&Scored| matches!(s.label, Label::Named(_));
    let named = table.iter().filter(is_named).find(passes);
    let generic = table.iter().filter(|s| !is_named(s)).find(passes);
    // An unnamed structure is measured against every name by the same held-out evidence. Where this runs to hundreds of
    // nats every formula is a little wrong: then a name that explains nine tenths of what the free function does is kept.
    let held_out = table.iter().filter(is_named).map(|s| s.evidence.held_out).fold(f64::NEG_INFINITY, f64::max);
    let nearly = |generic: &Scored| {
        table.iter().filter(is_named).filter(passes).find(|s| s.explained >= NEARLY_AS_MUCH * generic.explained)
    };
    let best = match (named, generic) {
        (Some(_), Some(generic)) if generic.score > held_out + settings.ambiguity_margin => {
            nearly(generic).unwrap_or(generic)
        }
        (Some(named), _) => named,
        (None, Some(generic)) => generic,
        (None, None) => return None,
    };
    let mut rivals = Vec::new();
    let mut margin = f64::INFINITY;
    let mut standings = Vec::new();
    for rival in table.iter().filter(|s| s.label != best.label) {
        let distance = best.score - rival.score;
        if let Label::Named(effect) = rival.label {
            standings.push((effect, distance));
        }
        match rival.label {
            Label::Named(effect) if matches!(best.label, Label::Named(_)) && distance < settings.ambiguity_margin => {
                rivals.push((effect, distance));
            }
            Label::Named(_) => margin = margin.min(distance),
            Label::Generic(_) => {}
        }
    }
    if let Label::Named(effect) = best.label
        && let Some(twin) = twin(effect, &best.shape, travel)
        && table.iter().any(|s| s.label == Label::Named(twin))
        && rivals.iter().all(|(rival, _)| *rival != twin)
    {
        rivals.push((twin, 0.0));
    }
    Some(Accepted {
        label: best.label.clone(),
        shape: best.shape.clone(),
        score: best.score,
        family_wise: best.family_wise,
        fold_gain: best.evidence.fold_gain.clone(),
        margin,
        rivals,
        standings,
    })
}

/// The effect whose equation coincides with another's: driving losses and torque scale wherever the joint moves faster
/// than the smoothing of its sign; a friction ripple that shows fewer than three periods and any function of position.
fn twin(effect: EffectId, shape: &[f64], travel: f64) -> Option<EffectId> {
    match effect {
        EffectId::DriveBackdrive => Some(EffectId::TorqueScale),
        EffectId::TorqueScale => Some(EffectId::DriveBackdrive),
        EffectId::PositionRipple if shape[1] == 1.0 && shape[0] * travel < 3.0 * std::f64::consts::TAU => {
            Some(EffectId::PositionFriction)
        }
        _ => None,
    }
}

impl Accepted {
    /// The effect's name: `unknown` for a generic rival.
    pub fn effect(&self) -> EffectId {
        match self.label {
            Label::Named(effect) => effect,
            Label::Generic(_) => EffectId::Unknown,
        }
    }

    /// The generic structure behind an `unknown`.
    pub fn generic(&self) -> Option<Generic> {
        match self.label {
            Label::Named(_) => None,
            Label::Generic(rival) => Some(rival),
        }
    }
}
