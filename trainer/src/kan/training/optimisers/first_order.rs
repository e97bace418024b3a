//! Training by gradients alone, for networks too large for a matrix of their unknowns and for comparison.

use std::ops::Range;

use super::lbfgs::{End, Iterate};
use super::{adam, lbfgs};
use crate::kan::training::dataset::{Dataset, row_count};
use crate::kan::training::jacobian::residual_sum_and_gradient;
use crate::kan::training::model::{Model, Unknowns};
use crate::kan::training::outcome::{Convergence, Status, Step};
use crate::kan::training::penalty::Penalty;
use crate::kan::training::settings::{Monitor, Optimiser, Settings, Smoothing};
use crate::kan::training::sparsity::SparsityPenalty;

/// Minimises mean squared error plus penalties; leaves the last point, or the best on validation rows, in the model.
/// Returns the mean squared normalised residual beside the convergence.
pub(super) fn minimise(
    model: &mut Model,
    dataset: &Dataset,
    rows: &[Range<usize>],
    settings: &Settings,
    monitor: &mut Monitor,
) -> (Convergence, f64) {
    let unknowns = Unknowns::of(model, settings.with_base);
    let samples = row_count(rows) as f64;
    let strength = match settings.smoothing {
        Smoothing::Fixed(strength) => strength,
        Smoothing::None | Smoothing::Estimated => 0.0,
    };
    let penalties = Penalty::smoothness(model, &unknowns, strength);
    let sparsity = SparsityPenalty::of(model, &unknowns, settings.sparsity, 1.0);
    let mut values = unknowns.read(model);
    let mut scratch = model.clone();
    let (mut evaluations, mut steps, mut gradient_norm) = (0, 0, f64::NAN);

    let mut objective = |values: &[f64]| {
        evaluations += 1;
        unknowns.write(values, &mut scratch);
        let (sum, gradient) = residual_sum_and_gradient(&scratch, &unknowns, dataset, rows);
        let mut gradient: Vec<f64> = gradient.into_iter().map(|g| g / samples).collect();
        let mut loss = sum / samples;
        for penalty in &penalties {
            loss += penalty.value(values);
            penalty.add_gradient(values, 2.0, &mut gradient);
        }
        loss += sparsity.value(values);
        sparsity.add_gradient(values, 2.0, &mut gradient);
        (loss, gradient)
    };
    let mut observe = |iterate: &Iterate| {
        unknowns.write(iterate.values, model);
        gradient_norm = iterate.gradient.iter().map(|g| g * g).sum::<f64>().sqrt();
        let smooth: f64 = penalties.iter().map(|penalty| penalty.value(iterate.values)).sum();
        let penalty = smooth + sparsity.value(iterate.values);
        let step = Step {
            step: steps,
            loss: (iterate.loss - penalty) * model.network.output.width.powi(2),
            validation_loss: None,
            gradient_norm,
            degrees_of_freedom: None,
        };
        steps += 1;
        monitor.observe(step, model, dataset)
    };
    let end = match settings.optimiser {
        Optimiser::Adam { rate } => adam::minimise(&mut values, settings.steps, rate, &mut objective, &mut observe),
        _ => lbfgs::minimise(&mut values, settings.steps, settings.tolerance, &mut objective, &mut observe),
    };
    unknowns.write(&values, model);
    monitor.restore_best(model);
    let status = match end {
        End::Flat => Status::Converged,
        End::NoDescent => Status::Stalled,
        End::Stopped => Status::ValidationRose,
        End::Limit => Status::StepLimit,
    };
    let convergence = Convergence { status, steps: steps.saturating_sub(1), evaluations, gradient_norm };
    (convergence, model.residual_sum(dataset, rows) / samples)
}
