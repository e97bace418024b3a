//! What grain and noise of the measurement give a candidate by themselves: those of the position enter the candidate through the
//! motion and the torque through the inertia, those of the torque enter what is worked out from it (errors in variables; Janot,
//! Vandanjon & Gautier 2014).

use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::evidence::score::Bench;
use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::noise::autoregression::{Noise, noise_features};
use crate::diagnose::preparation::states::{Prepared, identified_inertia};
use crate::numerics::least_squares::{gram, moments, solve_symmetric};
use crate::numerics::random::{normal, uniform};
use crate::numerics::statistics::DEVIATION_PER_MEDIAN;
use crate::numerics::statistics::quantile;
use crate::physics::JointState;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use std::ops::Range;

/// Seed of the added quantisation error: one for all recordings, so that every run draws the same.
const QUANTISATION_SEED: u64 = 0x0067_7261_696e;
/// Seed of the added sampling jitter: another, so that the one does not depend on whether the other is drawn.
const JITTER_SEED: u64 = 0x696e_7374_616e;

/// A second helping of the encoder's grain and of the torque's noise.
#[derive(Clone, Debug)]
pub(crate) struct MeasurementNoise {
    /// States with it.
    state: JointState,
    /// Filtered change of what the base leaves.
    left: Vec<f64>,
}

impl MeasurementNoise {
    /// Adds a uniform error of one step and the scatter of sampling to the position, and to the torque white noise as large as what a
    /// fitted base leaves in half of the rows. `None` where the recording shows no inertia.
    pub fn of(prepared: &Prepared, comparison: &Comparison, left_by_base: &[f64]) -> Option<Self> {
        let Comparison { signals, reference, .. } = comparison;
        let body_is_recorded = signals.rigid_body.is_some() && !signals.body_follows_position;
        let inertia = if body_is_recorded && reference.is_none() { 0.0 } else { identified_inertia(prepared)? };
        let [mut random, mut instants] = [QUANTISATION_SEED, JITTER_SEED].map(ChaCha8Rng::seed_from_u64);
        let steps = signals.position.iter().map(|q| q + signals.position_resolution * (uniform(&mut random) - 0.5));
        let late = prepared.state.velocity.iter().map(|v| prepared.sampling_jitter * v * normal(&mut instants));
        let position: Vec<f64> = steps.zip(late).map(|(q, late)| q + late).collect();
        let noise = torque_noise(prepared, left_by_base, &mut random);
        let torque: Vec<f64> = signals.torque.iter().zip(&noise).map(|(torque, noise)| torque + noise).collect();
        let mut state = prepared.state_at(&position, &torque);
        let inertial = state.map(|i| inertia * (state.acceleration[i] - prepared.state.acceleration[i]));
        state.predicted.iter_mut().zip(&inertial).for_each(|(predicted, change)| *predicted += change);
        let left: Vec<f64> = noise.iter().zip(&inertial).map(|(noise, inertial)| noise - inertial).collect();
        Some(Self { state, left: prepared.filtered(&left) })
    }

    /// What it does beside a bench.
    pub fn beside<'g>(&'g self, workbench: &'g Workbench<'g>, bench: &'g Bench, noise: &'g Noise) -> NoiseBeside<'g> {
        let runs = bench.runs();
        let mut left = workbench.whitened(std::slice::from_ref(&self.left), noise).swap_remove(0);
        bench.take_off_base(&mut left);
        NoiseBeside { state: &self.state, workbench, bench, noise, target: bench.target_beside_base(), left, runs }
    }
}

/// White noise of the torque at every sample, so large that behind the filter it is what a base leaves in half of the rows. How it is
/// spread over the states and how heavy its tails are tells what changes from sample to sample, which no effect does.
fn torque_noise(prepared: &Prepared, left_by_base: &[f64], random: &mut ChaCha8Rng) -> Vec<f64> {
    let runs = prepared.open_runs();
    let torque = &prepared.torque;
    let change = |&i: &usize| torque[i.saturating_sub(1)] - 2.0 * torque[i] + torque[(i + 1).min(torque.len() - 1)];
    let changes: Vec<f64> = prepared.rows.iter().map(change).collect();
    let model = Noise::fit(&changes, &runs, &noise_features(prepared));
    let white = model.whitened(&changes, &runs);
    let drawn: Vec<f64> = runs.iter().flat_map(|run| &white[run.clone()]).copied().collect();
    let of_most = |values: &[f64]| DEVIATION_PER_MEDIAN * quantile(values.iter().map(|value| value.abs()), 0.5);
    let usual_deviation = quantile(model.deviation.iter().copied(), 0.5);
    let scale =
        of_most(left_by_base) / prepared.filter.gain() / (of_most(&drawn) * usual_deviation).max(f64::MIN_POSITIVE);
    let mut row = 0;
    let at_sample = |sample: usize| {
        // Samples between working rows have the deviation of the row before.
        while prepared.rows.get(row + 1).is_some_and(|next| *next <= sample) {
            row += 1;
        }
        let index = ((uniform(random) * drawn.len() as f64) as usize).min(drawn.len().saturating_sub(1));
        scale * model.deviation.get(row).unwrap_or(&0.0) * drawn.get(index).unwrap_or(&0.0)
    };
    (0..prepared.torque.len()).map(at_sample).collect()
}

/// A second helping of grain and noise beside a bench.
pub(crate) struct NoiseBeside<'g> {
    state: &'g JointState,
    workbench: &'g Workbench<'g>,
    bench: &'g Bench,
    noise: &'g Noise,
    /// What the base leaves, whitened.
    target: Vec<f64>,
    /// Its change, whitened.
    left: Vec<f64>,
    runs: Vec<Range<usize>>,
}

impl NoiseBeside<'_> {
    /// Share of a candidate's evidence that the grain does not give it by itself, from 0 to 1.
    pub fn trust(&self, label: &Label, shape: &[f64]) -> f64 {
        let Self { state, workbench, bench, noise, target, left, runs } = self;
        let free = |columns: &[Vec<f64>]| {
            let mut white = workbench.whitened(columns, noise);
            white.iter_mut().for_each(|column| bench.take_off_base(column));
            white
        };
        let columns = workbench.filtered_columns(label, shape);
        let with_more = workbench.filtered_columns_at(state, label, shape);
        let change = |(more, column): (&Vec<f64>, &Vec<f64>)| more.iter().zip(column).map(|(m, c)| m - c).collect();
        let changes: Vec<Vec<f64>> = with_more.iter().zip(&columns).map(change).collect();
        let (columns, changes) = (free(&columns), free(&changes));
        let (asked_for, by_grain) = (moments(&columns, target, runs), moments(&changes, left, runs));
        let Some(coefficients) = solve_symmetric(&gram(&columns, runs), &asked_for) else { return 1.0 };
        let share = coefficients.dot(&by_grain) / coefficients.dot(&asked_for).max(f64::MIN_POSITIVE);
        (1.0 - share).clamp(0.0, 1.0).powi(2)
    }
}
