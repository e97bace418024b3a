//! The evidence that a recording, planned or made, holds between two effects.

use crate::diagnose::advice::{Pair, Question};
use crate::diagnose::comparison::base::Base;
use crate::diagnose::comparison::columns::BaseKind;
use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::evidence::score::Bench;
use crate::diagnose::hypotheses::fitted::Fitted;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::hypotheses::refine::refine;
use crate::diagnose::noise::autoregression::Noise;
use crate::diagnose::preparation::states::Prepared;
use crate::numerics::least_squares::{least_squares, residual, weighted};
use crate::physics::{EffectId, Hypothesis, Shape, catalogue};
use std::ops::Range;

/// A recording behind its filter, whitened by the noise of the part that was made.
pub(crate) struct Outlook {
    prepared: Prepared,
    hypotheses: Vec<Box<dyn Hypothesis + Send>>,
    noise: Noise,
    /// Filtered base columns, then those of every finding that has a name.
    columns: Vec<Vec<f64>>,
    /// Place of each finding's columns.
    places: Vec<(EffectId, Range<usize>)>,
    /// Open runs of the part that was made.
    made: Vec<Range<usize>>,
    /// All open runs.
    open: Vec<Range<usize>>,
}

impl Outlook {
    /// Prepares signals of which the part as long as the recording was recorded. `None` where the base cannot be
    /// determined.
    pub(crate) fn new(question: &Question, mut comparison: Comparison) -> Option<Self> {
        let (cut_off, lock) = (question.diagnosis.cut_off_hz, question.diagnosis.lock);
        let prepare =
            |comparison: &Comparison| Prepared::at_cut_off(&comparison.signals, cut_off, comparison.known(), lock);
        let mut prepared = prepare(&comparison);
        if question.diagnosis.base == BaseKind::Reference && comparison.reference.is_none() {
            comparison = Comparison::with(comparison.signals, question.reference?(&prepared.state)?);
            prepared = prepare(&comparison);
        }
        let base = Base::fit(&mut prepared, &comparison, question.diagnosis.base)?;
        let recorded = question.comparison.signals.time.len();
        let open = prepared.open_runs();
        let made: Vec<Range<usize>> = open.iter().filter(|run| prepared.rows[run.start] < recorded).cloned().collect();
        let hypotheses = catalogue();
        let mut columns = base.columns.clone();
        let mut places = Vec::new();
        for found in &question.diagnosis.findings {
            let Label::Named(effect) = found.fitted.label else { continue };
            let Some(hypothesis) = hypotheses.iter().find(|h| h.id() == effect) else { continue };
            let begin = columns.len();
            columns.extend(prepared.filtered_all(&hypothesis.columns(&prepared.state, &found.fitted.shape)));
            places.push((effect, begin..columns.len()));
        }
        let coefficients = least_squares(&columns, &base.target, &made)?;
        let noise = Noise::fit(&residual(&columns, &base.target, &coefficients), &made, &[]);
        Some(Self { prepared, hypotheses, noise, columns, places, made, open })
    }

    /// Expected evidence of every pair; none where the states do not determine it.
    pub(crate) fn evidence(&self, pairs: &[Pair], refined: bool) -> Vec<f64> {
        pairs.iter().map(|(_, found, rival)| self.evidence_between(found, *rival, refined).unwrap_or(0.0)).collect()
    }

    /// Expected log-evidence in nats between a finding and a rival that takes its place, whichever of both is true: half
    /// the whitened energy of the true one's torque that base and the other leave. The rival's own torque is the one
    /// with which it imitates the finding in the part that was made. `refined` lets the other choose its shape freely.
    fn evidence_between(&self, found: &Fitted, rival: EffectId, refined: bool) -> Option<f64> {
        let Label::Named(effect) = found.label else { return None };
        let torque = self.white(&weighted(&self.filtered(effect, &found.shape)?, &found.coefficients));
        let base = self.base_without(effect);
        let bench = |torque: &[f64], runs: &[Range<usize>]| {
            Bench::new(base.clone(), Vec::new(), torque.to_vec(), vec![runs.to_vec()])
        };
        let made = bench(&torque, &self.made);
        let Some((shape, coefficients)) = self.imitate(&made, rival, None, false).map(|best| (best.1, best.2)) else {
            // The recording has no room for the rival at all.
            return bench(&torque, &self.open).alone().map(|alone| 0.5 * alone.residual);
        };
        let both = bench(&torque, &self.open);
        let against_rival = self.imitate(&both, rival, Some(&shape), refined)?.0;
        let imitation = self.white(&weighted(&self.filtered(rival, &shape)?, &coefficients));
        let against_found = self.imitate(&bench(&imitation, &self.open), effect, Some(&found.shape), refined)?.0;
        Some(0.5 * against_rival.min(against_found))
    }

    /// The shape and coefficients with which an effect comes closest to the bench's target: energy that it leaves, shape,
    /// coefficients. `None` where it has no shape that differs from the base.
    fn imitate(
        &self,
        bench: &Bench,
        effect: EffectId,
        also: Option<&Shape>,
        refined: bool,
    ) -> Option<(f64, Shape, Vec<f64>)> {
        let state = &self.prepared.state;
        let hypothesis = self.hypotheses.iter().find(|h| h.id() == effect)?;
        let weigh = |shape: &[f64]| {
            let columns: Vec<Vec<f64>> = self.filtered(effect, shape)?.iter().map(|c| self.white(c)).collect();
            bench.weigh(&columns, &[], false)
        };
        let mut shapes = hypothesis.shapes(state);
        shapes.extend(also.cloned());
        let (_, shape) = shapes
            .into_iter()
            .filter_map(|shape| Some((weigh(&shape)?.residual, shape)))
            .min_by(|a, b| a.0.total_cmp(&b.0))?;
        let shape = if refined {
            refine(hypothesis.as_ref(), state, &shape, |shape| weigh(shape).map(|evidence| -evidence.residual))
        } else {
            shape
        };
        let evidence = weigh(&shape)?;
        Some((evidence.residual, shape, evidence.coefficients))
    }

    /// Whitened columns of the base and of every finding but those of one effect.
    fn base_without(&self, effect: EffectId) -> Vec<Vec<f64>> {
        let taken = |i: usize| self.places.iter().any(|(id, place)| *id == effect && place.contains(&i));
        let kept = self.columns.iter().enumerate().filter(|(i, _)| !taken(*i));
        kept.map(|(_, column)| self.white(column)).collect()
    }

    /// Columns of an effect at the states; `None` where these have none of it, as a planned motion has no commands.
    fn filtered(&self, effect: EffectId, shape: &[f64]) -> Option<Vec<Vec<f64>>> {
        let hypothesis = self.hypotheses.iter().find(|h| h.id() == effect)?;
        let columns = hypothesis.columns(&self.prepared.state, shape);
        (!columns.is_empty()).then(|| self.prepared.filtered_all(&columns))
    }

    fn white(&self, column: &[f64]) -> Vec<f64> {
        self.noise.whitened(column, &self.open)
    }
}
