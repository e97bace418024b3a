//! Base and candidates of one prepared recording: their filtered columns, whitened and weighed on the open rows.

use crate::diagnose::comparison::base::{Base, Delay};
use crate::diagnose::evidence::score::Bench;
use crate::diagnose::hypotheses::design::Design;
use crate::diagnose::hypotheses::fitted::Fitted;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::noise::autoregression::{Noise, noise_features};
use crate::diagnose::preparation::states::Prepared;
use crate::numerics::least_squares::{dot, fit_residual, rows_in, weighted};
use crate::physics::{EffectId, Hypothesis, JointState, KNOWN_WITHIN_SHARE};
use rayon::prelude::*;

/// Standard deviations of its prior that a coefficient which physics knows may be off: three, as is usual for a normal deviate.
const MOST_DEVIATIONS: f64 = 3.0;

/// What every later stage weighs with: the prepared recording, its base and the design of all candidates.
pub struct Workbench<'a> {
    pub(crate) prepared: &'a Prepared,
    pub(crate) base: &'a Base,
    pub(crate) design: Design,
    pub(crate) hypotheses: &'a [Box<dyn Hypothesis + Send>],
    noise_features: Vec<Vec<f64>>,
}

impl<'a> Workbench<'a> {
    /// Builds the design of every hypothesis that the recording can show.
    pub fn new(prepared: &'a Prepared, base: &'a Base, hypotheses: &'a [Box<dyn Hypothesis + Send>]) -> Self {
        let left_out: &[EffectId] = if base.delay == Delay::Open { &[] } else { &[EffectId::TimeMisalignment] };
        let design = Design::new(prepared, hypotheses, left_out);
        Self { prepared, base, design, hypotheses, noise_features: noise_features(prepared) }
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
                self.base.reference_effects.is_empty()
                    && self.hypothesis(*effect).is_some_and(Hypothesis::only_positive)
            }
            Label::Generic(_) => false,
        }
    }

    /// Whether a label can have these coefficients with a shape.
    pub(crate) fn is_possible(&self, label: &Label, shape: &[f64], coefficients: &[f64]) -> bool {
        let is_passive = || match label {
            Label::Named(effect) => {
                self.hypothesis(*effect).is_none_or(|h| h.is_passive(&self.prepared.state, shape, coefficients))
            }
            Label::Generic(_) => true,
        };
        let is_as_known = || {
            let Label::Named(effect) = label else { return true };
            let known = self.hypothesis(*effect).and_then(|h| h.known_coefficient(shape));
            let most = MOST_DEVIATIONS * KNOWN_WITHIN_SHARE;
            known.is_none_or(|known| coefficients.iter().all(|c| (c / known - 1.0).abs() <= most))
        };
        (!self.only_positive(label) || coefficients.iter().all(|c| *c > 0.0)) && is_passive() && is_as_known()
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

    /// Filtered columns of the base and of candidates with their shapes.
    pub(crate) fn base_with<'f>(&self, candidates: impl IntoIterator<Item = (&'f Label, &'f [f64])>) -> Vec<Vec<f64>> {
        let mut columns = self.base.columns.clone();
        columns.extend(candidates.into_iter().flat_map(|(label, shape)| self.filtered_columns(label, shape)));
        columns
    }

    /// The same with the change of each candidate's columns with its shape, so that a small error of the shape is in the span.
    pub(crate) fn base_with_tangents<'f>(
        &self,
        candidates: impl IntoIterator<Item = (&'f Label, &'f [f64])>,
    ) -> Vec<Vec<f64>> {
        let mut columns = self.base.columns.clone();
        for (label, shape) in candidates {
            columns.extend(self.filtered_columns(label, shape));
            columns.extend(self.column_tangents(label, shape).into_iter().flat_map(|(_, columns)| columns));
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

    pub(crate) fn whitened(&self, columns: &[Vec<f64>], noise: &Noise) -> Vec<Vec<f64>> {
        let runs = self.prepared.open_runs();
        columns.par_iter().map(|column| noise.whitened(column, &runs)).collect()
    }

    pub(crate) fn bench(&self, base: Vec<Vec<f64>>, noise: &Noise) -> Bench {
        let target = self.whitened(std::slice::from_ref(&self.base.target), noise).swap_remove(0);
        let uncertain = self.whitened(&self.base.uncertainty, noise);
        Bench::new(self.whitened(&base, noise), uncertain, target, self.prepared.open_blocks())
    }

    /// White noise of what the base leaves: what is assumed before the noise is known.
    pub(crate) fn white_noise(&self) -> Noise {
        let runs = self.prepared.open_runs();
        let energy = dot(&self.base.residual, &self.base.residual, &runs);
        let deviation = (energy / rows_in(&runs).max(1) as f64).sqrt().max(f64::MIN_POSITIVE);
        Noise::white(self.prepared.rows.len(), deviation)
    }

    /// Noise of what the columns leave after an ordinary least-squares fit: one that is whitened first may leave slow
    /// errors that pass for noise.
    pub(crate) fn noise_after(&self, columns: &[Vec<f64>]) -> Noise {
        self.noise_of(&self.left_by(columns))
    }

    /// What the columns leave of the target after an ordinary least-squares fit.
    pub(crate) fn left_by(&self, columns: &[Vec<f64>]) -> Vec<f64> {
        let left = fit_residual(columns, &self.base.target, &self.prepared.open_runs());
        left.unwrap_or_else(|| self.base.target.clone())
    }

    /// The noise of a residual.
    pub(crate) fn noise_of(&self, residual: &[f64]) -> Noise {
        Noise::fit(residual, &self.prepared.open_runs(), &self.noise_features)
    }
}
