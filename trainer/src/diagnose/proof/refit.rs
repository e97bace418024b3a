//! All parameters together once the effects are chosen: continuous shapes, coefficients, intervals.

use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::fitted::Fitted;
use crate::diagnose::hypotheses::label::{Label, ridge_of};
use crate::diagnose::hypotheses::refine::refine;
use crate::diagnose::noise::autoregression::Noise;
use crate::diagnose::search::accepted::{Accepted, others};
use crate::numerics::covariance;
use crate::numerics::least_squares::{dot, least_squares, residual, rows_in, weighted};
use crate::physics::{EffectId, Shape};
use nalgebra::{DMatrix, DVector};

/// The joint refit of base and effects.
#[derive(Clone, Debug)]
pub struct Refit {
    /// Coefficients of the base columns, physical first.
    pub base: Vec<f64>,
    /// Deviations of the base coefficients.
    pub base_deviation: Vec<f64>,
    /// The effects.
    pub effects: Vec<Fitted>,
    /// Covariance of the coefficients of base and effects.
    pub covariance: DMatrix<f64>,
    /// Noise of what is left.
    pub noise: Noise,
    /// Whether it is a plain least-squares fit, because what is left is the error of formulas rather than noise.
    pub plain: bool,
}

impl Refit {
    /// Deviation of the fitted torque at every working row by that of the coefficients; rows that nothing like them is fitted to have a large one.
    pub(crate) fn torque_deviation(&self, workbench: &Workbench) -> Vec<f64> {
        let columns = workbench.base_with(self.effects.iter().map(|effect| (&effect.label, &effect.shape[..])));
        let deviation = |row: usize| {
            let torque = DVector::from_fn(columns.len(), |i, _| columns[i][row]);
            torque.dot(&(&self.covariance * &torque)).max(0.0).sqrt()
        };
        (0..workbench.prepared.rows.len()).map(deviation).collect()
    }

    /// The same with the parameters of a reference back where they were given: nuisances and effects stay.
    pub(crate) fn with_base_as_given(&self, workbench: &Workbench) -> Self {
        let mut given = self.clone();
        given.base[..workbench.base.names.len()].fill(0.0);
        given
    }
}

/// Sweeps over the shapes, one effect at a time with the others in the base. A limit of the computing time: the second
/// corrects what the first did beside unrefined others.
const SWEEPS: usize = 2;

/// Error of a whitened fit over that of a plain one (root mean squares), above which what is left is the slow error of
/// the model's formulas and not noise, and the plain fit holds. Chosen by judgement: white noise makes them equal;
/// smaller gives up whitening for coloured noise, larger biases all coefficients.
const PLAIN_FIT_ERROR_RATIO: f64 = 1.1;

/// Moves the shapes of the accepted effects to their joint optimum: one effect at a time, the others in the base.
pub(crate) fn polish(workbench: &Workbench, accepted: &mut [Accepted], noise: &Noise) {
    let state = &workbench.prepared.state;
    let plain = refit(workbench, accepted).is_some_and(|refit| refit.plain);
    let white = workbench.white_noise();
    let noise = if plain { &white } else { noise };
    let sweeps = if accepted.len() > 1 { SWEEPS } else { 1 };
    for _ in 0..sweeps {
        for index in 0..accepted.len() {
            let Label::Named(effect) = accepted[index].label else { continue };
            let Some(hypothesis) = workbench.hypothesis(effect) else { continue };
            let bench = workbench.bench(workbench.base_with(others(accepted, index).map(Accepted::term)), noise);
            let label = accepted[index].label.clone();
            let weigh = |shape: &[f64]| {
                let columns = workbench.whitened(&workbench.filtered_columns(&label, shape), noise);
                let evidence = bench.weigh(&columns, &[], false)?;
                workbench.is_possible(&label, shape, &evidence.coefficients).then_some(evidence)
            };
            if plain {
                // The variant was chosen by what is fast in it; now by all that it explains.
                let gain = |shape: &Shape| weigh(shape).map(|evidence| evidence.criterion(bench.rows()));
                let variants = hypothesis.shapes(state).into_iter().filter_map(|shape| Some((gain(&shape)?, shape)));
                if let Some((_, best)) = variants.max_by(|a, b| a.0.total_cmp(&b.0)) {
                    accepted[index].shape = best;
                }
            }
            accepted[index].shape =
                refine(hypothesis, state, &accepted[index].shape, |shape| weigh(shape).map(|e| e.statistic));
            if let (EffectId::TransientEvent, &[start, end]) = (effect, &accepted[index].shape[..]) {
                // An end that lies beside the open rows could lie anywhere there.
                accepted[index].shape = workbench.prepared.shown_by_open_rows([start, end]).to_vec();
            }
        }
    }
}

/// Refits base and effects together, shapes as they stand, by generalised least squares with the colour of what is left
/// (plain ones where whitening costs too much of the fit, with intervals from block to block); the shapes' uncertainty by
/// Gauss-Newton. `None` where the system is singular.
pub(crate) fn refit(workbench: &Workbench, accepted: &[Accepted]) -> Option<Refit> {
    let base_width = workbench.base.columns.len();
    let mut columns = workbench.base.columns.clone();
    let mut places = Vec::new();
    let mut ridge = vec![0.0; base_width];
    for effect in accepted {
        let begin = columns.len();
        columns.extend(workbench.filtered_columns(&effect.label, &effect.shape));
        places.push(begin..columns.len());
        ridge.extend(ridge_of(&effect.label, &effect.shape));
        ridge.resize(columns.len(), 0.0);
    }
    let noise = workbench.noise_after(&columns);
    let bench = workbench.bench(columns.clone(), &noise);
    let runs = bench.runs();
    let mut solution = bench.solve(&ridge)?;
    let white = residual(bench.base(), &bench.target, &solution);
    let mut left = residual(&columns, &workbench.base.target, &solution);
    let rows = rows_in(&runs);
    let plain = (dot(&left, &left, &runs) / rows as f64).sqrt() > PLAIN_FIT_ERROR_RATIO * noise.rms;
    if plain {
        solution = least_squares(&columns, &workbench.base.target, &runs)?;
        left = residual(&columns, &workbench.base.target, &solution);
    }
    let mut effects: Vec<Fitted> = accepted
        .iter()
        .zip(&places)
        .map(|(effect, place)| Fitted {
            label: effect.label.clone(),
            shape: effect.shape.clone(),
            shape_deviation: vec![None; effect.shape.len()],
            coefficients: solution[place.clone()].to_vec(),
            deviation: Vec::new(),
        })
        .collect();
    let covariance_with = |tangents: &[Vec<f64>]| {
        if plain {
            let all: Vec<Vec<f64>> = columns.iter().chain(tangents).cloned().collect();
            covariance::of_blocks(&all, &left, &bench.blocks)
        } else {
            let all: Vec<Vec<f64>> = bench.base().iter().cloned().chain(workbench.whitened(tangents, &noise)).collect();
            covariance::of_whitened(&all, &white, &ridge, &runs)
        }
    };
    // Shapes that were fitted too make every interval wider: their tangents join the normal matrix (Gauss-Newton).
    let (owners, tangents) = shape_tangents(workbench, &effects);
    let (covariance, owners) = match covariance_with(&tangents) {
        Some(widened) => (widened, owners),
        None => (covariance_with(&[])?, Vec::new()),
    };
    let deviation = |i: usize| covariance[(i, i)].max(0.0).sqrt();
    for (effect, place) in effects.iter_mut().zip(places) {
        effect.deviation = place.map(deviation).collect();
    }
    for (row, (index, slot)) in (columns.len()..).zip(owners) {
        effects[index].shape_deviation[slot] = Some(deviation(row));
    }
    Some(Refit {
        base: solution[..base_width].to_vec(),
        covariance: covariance.view((0, 0), (columns.len(), columns.len())).clone_owned(),
        base_deviation: (0..base_width).map(deviation).collect(),
        effects,
        noise,
        plain,
    })
}

/// Change of the torque with each free shape parameter of the effects, filtered, with the effect and the place of the parameter.
fn shape_tangents(workbench: &Workbench, effects: &[Fitted]) -> (Vec<(usize, usize)>, Vec<Vec<f64>>) {
    let tangents = effects.iter().enumerate().flat_map(|(index, effect)| {
        let of_columns = workbench.column_tangents(&effect.label, &effect.shape).into_iter();
        of_columns.map(move |(slot, columns)| ((index, slot), weighted(&columns, &effect.coefficients)))
    });
    tangents.unzip()
}
