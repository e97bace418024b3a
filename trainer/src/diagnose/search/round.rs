//! One round of the search: the noise as it stands, every hypothesis weighed, the leaders refined, all ranked.

use crate::diagnose::evidence::overdispersion::overdispersion;
use crate::diagnose::evidence::score::{Bench, GroupEvidence, VariantEvidence};
use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::design::{Group, Variant};
use crate::diagnose::hypotheses::label::{Label, ridge_of};
use crate::diagnose::hypotheses::refine::refine;
use crate::diagnose::noise::autoregression::Noise;
use crate::diagnose::noise::null_draws::{Family, NullDraws, NullGroup, chi_square_surprise};
use crate::diagnose::search::accepted::Accepted;
use crate::diagnose::search::scored::{Scored, score_of};
use crate::diagnose::search::setup::Search;
use crate::diagnose::search::thresholds::Settings;
use crate::numerics::least_squares::{least_squares, orthonormal, project_out, weighted};
use crate::physics::EffectId;
use rayon::prelude::*;
use std::ops::Range;

/// Shapes that a refinement distinguishes between two points of the grid, for each free shape parameter: their
/// logarithm is taken off the surprise, as the null draws stay on the grid. Chosen by judgement: steps down to a
/// hundredth of the grid are tried, but neighbours are one hypothesis; larger loses weak effects.
const SHAPES_PER_GRID_STEP: f64 = 10.0;

/// Criterion above which a candidate does not belong to the noise that the null draws are made of, nats. Chosen by
/// judgement: with what is less the draws keep the chance directions that look best; lower makes the noise of slow
/// hypotheses seem too small, higher leaves effects in the noise.
const CLEAR_CANDIDATE_NATS: f64 = 10.0;

/// Evidence of every variant of every group; `None` where a variant depends on the base.
type Tested = Vec<Vec<Option<VariantEvidence>>>;

pub(crate) struct Round<'s, 'a> {
    pub(crate) search: &'s Search<'a>,
    pub(crate) noise: Noise,
    pub(crate) bench: Bench,
    alone: Option<VariantEvidence>,
    variants: Tested,
    /// What base and best candidates leave, whitened.
    left: Vec<f64>,
    /// Largest energy that each group explains before whitening.
    explained: Vec<f64>,
}

impl<'s, 'a> Round<'s, 'a> {
    pub(crate) fn new(search: &'s Search<'a>, base: Vec<Vec<f64>>) -> Self {
        // Noise from the base and the two best candidates: from the bare base the effect would pass for noise, and a slow
        // effect for colour. So the first candidates are chosen as if the noise were white.
        let mut noise = search.workbench.white_noise();
        let mut explained = Vec::new();
        let mut left = Vec::new();
        for _ in 0..2 {
            let (bench, variants) = weigh_all(search.workbench, base.clone(), &noise, false);
            if explained.is_empty() {
                let largest = |(group, tested): (&Group, &Vec<Option<VariantEvidence>>)| {
                    let tested =
                        group.variants.iter().zip(tested).filter_map(|(variant, v)| Some((variant, v.as_ref()?)));
                    let possible = tested.filter(|(variant, v)| {
                        search.workbench.is_possible(&group.label, &variant.shape, &v.coefficients)
                    });
                    possible.map(|(_, v)| v.statistic).fold(0.0, f64::max)
                };
                explained = search.workbench.design.groups.iter().zip(&variants).map(largest).collect();
            }
            let mut generous = base.clone();
            generous.extend(best_two(search.workbench, &variants, bench.rows(), f64::NEG_INFINITY));
            left = search.workbench.left_by(&generous);
            noise = search.workbench.noise_of(&left);
        }
        let left = search.workbench.whitened(&[left], &noise).swap_remove(0);
        let (bench, variants) = weigh_all(search.workbench, base, &noise, true);
        let alone = bench.alone();
        Self { search, noise, bench, alone, variants, left, explained }
    }

    pub(crate) fn draw_null(&self) -> NullDraws {
        let best = best_two(self.search.workbench, &self.variants, self.bench.rows(), CLEAR_CANDIDATE_NATS);
        let runs = self.bench.runs();
        let design = &self.search.workbench.design;
        let in_the_draws = |(group, evidence): (&'_ Group, &'_ Vec<Option<VariantEvidence>>)| {
            let weighed =
                group.variants.iter().zip(evidence).filter(|(variant, evidence)| {
                    evidence.is_some() && ridge_of(&group.label, &variant.shape).is_empty()
                });
            let weighed: Vec<Range<usize>> = weighed.map(|(variant, _)| variant.columns.clone()).collect();
            let directions = move || {
                let of_variant = |columns: &Range<usize>| {
                    let white = |column: &Vec<f64>| self.noise.whitened(column, &self.bench.runs());
                    let mut columns: Vec<Vec<f64>> = design.columns[columns.clone()].iter().map(white).collect();
                    columns.iter_mut().for_each(|column| self.bench.take_off_base(column));
                    orthonormal(&columns, &self.bench.runs())
                };
                weighed.iter().map(of_variant).collect()
            };
            NullGroup {
                family: match group.label {
                    Label::Named(_) => Family::Named,
                    Label::Generic(_) => Family::Generic,
                },
                only_positive: self.search.workbench.only_positive(&group.label),
                directions: Box::new(directions),
            }
        };
        let groups: Vec<NullGroup> = design.groups.iter().zip(&self.variants).map(in_the_draws).collect();
        let mut rest = self.bench.target_beside_base();
        let mut best = self.search.workbench.whitened(&best, &self.noise);
        best.iter_mut().for_each(|column| self.bench.take_off_base(column));
        project_out(&mut rest, &orthonormal(&best, &runs), &runs);
        let Settings { null_draws, seed, .. } = self.search.settings;
        NullDraws::draw(&groups, &rest, &runs, null_draws, seed)
    }

    pub(crate) fn score_table(&self, accepted: &[Accepted]) -> Vec<Scored> {
        let Some(alone) = &self.alone else { return Vec::new() };
        let rows = self.bench.rows();
        let mut table: Vec<Scored> = self
            .search
            .workbench
            .design
            .groups
            .iter()
            .enumerate()
            .filter(|(_, group)| self.search.may_be_found(&group.label, accepted))
            .filter_map(|(index, group)| {
                let grid = self.search.workbench.grid_size(index);
                let admissible = self.admissible(index);
                let evidence = GroupEvidence::weigh(alone, &admissible, rows, grid)?;
                let scanned = self.search.workbench.scanned_beyond(index);
                // A prior adds no direction: what it weighs is calibrated by the free series.
                let free = group.variants.iter().zip(&admissible);
                let surprise = free
                    .filter(|(variant, _)| ridge_of(&group.label, &variant.shape).is_empty())
                    .filter_map(|(_, evidence)| evidence.as_ref())
                    .map(|v| chi_square_surprise(v.statistic, v.degrees) - scanned)
                    .fold(0.0, f64::max);
                Some(Scored {
                    label: group.label.clone(),
                    shape: group.variants[evidence.best].shape.clone(),
                    score: score_of(&group.label, &evidence, grid),
                    own_score: 0.0,
                    family_wise: 1.0,
                    evidence,
                    group: index,
                    surprise,
                    explained: self.explained[index],
                })
            })
            .collect();
        self.refine_leaders(&mut table, alone, rows);
        self.discount_noise(&mut table);
        table.sort_by(|a, b| b.score.total_cmp(&a.score));
        table
    }

    /// Takes from every candidate what the encoder's grain gives it by itself, and by how much more its evidence scatters than the model of
    /// the noise says.
    fn discount_noise(&self, table: &mut [Scored]) {
        let least = self.search.settings.candidate_score;
        if table.iter().all(|scored| scored.score <= least) {
            return;
        }
        let workbench = self.search.workbench;
        let grain = self.search.measurement_noise.map(|grain| grain.beside(workbench, &self.bench, &self.noise));
        let target = self.bench.target_beside_base();
        let scatters: Vec<f64> = table
            .par_iter_mut()
            .map(|scored| {
                if scored.score <= least {
                    return 1.0;
                }
                if let Some(grain) = &grain {
                    let trust = grain.trust(&scored.label, &scored.shape);
                    scored.score *= trust;
                    scored.surprise *= trust;
                }
                self.overdispersion_of(&scored.label, &scored.shape, &target)
            })
            .collect();
        // One measure for all that are compared, so that a near tie does not hang on it: the leader's. An event has the noise of its time.
        let is_event = |scored: &Scored| scored.label == Label::Named(EffectId::TransientEvent);
        let lasting = table.iter().zip(&scatters).filter(|(scored, _)| !is_event(scored));
        let of_leader =
            lasting.max_by(|(a, _), (b, _)| a.score.total_cmp(&b.score)).map_or(1.0, |(_, scatter)| *scatter);
        for (scored, own) in table.iter_mut().zip(scatters) {
            scored.surprise /= own;
            scored.own_score = scored.score / own;
            scored.score /= if is_event(scored) { own } else { of_leader };
        }
    }

    /// Overdispersion along the torque that a candidate is fitted to the target with, beside the base.
    fn overdispersion_of(&self, label: &Label, shape: &[f64], target: &[f64]) -> f64 {
        let workbench = self.search.workbench;
        let mut columns = workbench.whitened(&workbench.filtered_columns(label, shape), &self.noise);
        columns.iter_mut().for_each(|column| self.bench.take_off_base(column));
        let coefficients = least_squares(&columns, target, &self.bench.runs());
        coefficients.map_or(1.0, |fitted| overdispersion(&weighted(&columns, &fitted), &self.left, &self.bench.blocks))
    }

    /// The variants of a group whose coefficients have a possible sign.
    fn admissible(&self, group: usize) -> Vec<Option<VariantEvidence>> {
        let workbench = self.search.workbench;
        let Group { label, variants, .. } = &workbench.design.groups[group];
        let of_shape = |(shape, tested): (&[f64], &Option<VariantEvidence>)| {
            tested.clone().filter(|evidence| workbench.is_possible(label, shape, &evidence.coefficients))
        };
        variants.iter().map(|variant| &variant.shape[..]).zip(&self.variants[group]).map(of_shape).collect()
    }

    /// Refines the shapes of the leading named effects, so that no rival loses by the coarseness of its grid.
    fn refine_leaders(&self, table: &mut [Scored], alone: &VariantEvidence, rows: f64) {
        /// Distance to the leading name within which shapes are refined, nats. A limit of the computing time: coarser
        /// grids lose less.
        const REFINED_WITHIN_NATS: f64 = 15.0;
        /// Score over that of the leading name above which they are refined as well: a resonance between two of the grid may lose
        /// three quarters of it.
        const REFINED_SCORE_SHARE: f64 = 0.25;
        /// Distance to the leading name, nats, from which none is refined whatever its share: behind so clear a lead the next rounds
        /// are for what is left.
        const REFINED_AT_MOST_WITHIN_NATS: f64 = 100.0;
        let named = table.iter().filter(|s| matches!(s.label, Label::Named(_)));
        let lead = named.map(|s| s.score).fold(f64::NEG_INFINITY, f64::max);
        let threshold = (lead - REFINED_WITHIN_NATS)
            .min((REFINED_SCORE_SHARE * lead).max(lead - REFINED_AT_MOST_WITHIN_NATS))
            .max(0.0);
        table.par_iter_mut().for_each(|scored| {
            let Label::Named(effect) = scored.label else { return };
            let Some(hypothesis) = self.search.workbench.hypothesis(effect) else { return };
            if scored.score < threshold {
                return;
            }
            let state = &self.search.workbench.prepared.state;
            let white = |shape: &[f64]| {
                self.search
                    .workbench
                    .whitened(&self.search.workbench.filtered_columns(&scored.label, shape), &self.noise)
            };
            let weigh = |shape: &[f64]| {
                let evidence = self.bench.evidence(&white(shape))?;
                self.search.workbench.is_possible(&scored.label, shape, &evidence.coefficients).then_some(evidence)
            };
            let shape = refine(hypothesis, state, &scored.shape, |shape| weigh(shape).map(|e| e.statistic));
            let grid = self.search.workbench.grid_size(scored.group);
            let Some(refined) = weigh(&shape) else { return };
            if let Some(evidence) = GroupEvidence::weigh(alone, &[Some(refined)], rows, grid) {
                let score = score_of(&scored.label, &evidence, grid);
                if score > scored.score {
                    let free = (0..shape.len()).filter(|&i| hypothesis.bounds(state, i, &shape).is_some()).count();
                    let looked_at =
                        SHAPES_PER_GRID_STEP.ln() * free as f64 + self.search.workbench.scanned_beyond(scored.group);
                    let refined = chi_square_surprise(evidence.statistic, evidence.degrees) - looked_at;
                    scored.surprise = scored.surprise.max(refined);
                    scored.shape = shape;
                    scored.score = score;
                    scored.evidence = evidence;
                }
            }
        });
    }
}

/// Whitens the design, group by group, and weighs every variant, held-out folds only where asked for.
fn weigh_all(workbench: &Workbench, base: Vec<Vec<f64>>, noise: &Noise, folds: bool) -> (Bench, Tested) {
    let bench = workbench.bench(base, noise);
    let (design, runs) = (&workbench.design, bench.runs());
    let tested = |group: &Group| {
        let first = group.variants.iter().map(|variant| variant.columns.start).min().unwrap_or(0);
        let end = group.variants.iter().map(|variant| variant.columns.end).max().unwrap_or(first);
        let white: Vec<Vec<f64>> =
            design.columns[first..end].iter().map(|column| noise.whitened(column, &runs)).collect();
        let weigh = |variant: &Variant| {
            let columns = variant.columns.start - first..variant.columns.end - first;
            bench.weigh(&white[columns], &ridge_of(&group.label, &variant.shape), folds)
        };
        group.variants.iter().map(weigh).collect()
    };
    let tested = design.groups.par_iter().map(tested).collect();
    (bench, tested)
}

/// Criterion for each row above which a candidate is dominant, nats: 1/2 ln(1/(1 - 0.18)), so that it explains a fifth
/// of what the base leaves. Slow functions that take up parts of a one-off event of that size would else leave its
/// edges to the noise.
const DOMINANT_NATS_PER_ROW: f64 = 0.1;

/// Rows for each coefficient of a candidate that the noise is judged beside. Chosen by judgement: in fewer a series
/// takes up so much of the slow noise that whatever is slow seems more than noise; more leave the effect in the noise.
const ROWS_PER_COEFFICIENT_BESIDE_NOISE: f64 = 150.0;

/// Unwhitened columns of the two groups whose best variants have the largest criteria, and more than `least` nats; and of a
/// dominant event.
fn best_two(workbench: &Workbench, variants: &Tested, rows: f64, least: f64) -> Vec<Vec<f64>> {
    let is_dominant = |gain: f64| gain > DOMINANT_NATS_PER_ROW * rows;
    let mut gains: Vec<(f64, usize, usize)> = Vec::new();
    for (group, tested) in variants.iter().enumerate() {
        let criterion = |(i, v): (usize, &Option<VariantEvidence>)| {
            let v = v.as_ref()?;
            let gain = v.criterion(rows);
            (is_dominant(gain) || v.degrees as f64 * ROWS_PER_COEFFICIENT_BESIDE_NOISE <= rows).then_some((gain, i))
        };
        let criteria = tested.iter().enumerate().filter_map(criterion);
        let best = criteria.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(gain, _)| *gain > least);
        gains.extend(best.map(|(gain, variant)| (gain, group, variant)));
    }
    gains.sort_by(|a, b| b.0.total_cmp(&a.0));
    let is_dominant_event = |(gain, group, _): &&(f64, usize, usize)| {
        let event = Label::Named(EffectId::TransientEvent);
        is_dominant(*gain) && workbench.design.groups[*group].label == event
    };
    gains
        .iter()
        .take(2)
        .chain(gains.iter().skip(2).filter(is_dominant_event))
        .flat_map(|(_, group, variant)| {
            workbench.design.columns[workbench.design.groups[*group].variants[*variant].columns.clone()].to_vec()
        })
        .collect()
}
