//! Damped Gauss-Newton (Levenberg, 1944; Marquardt, 1963) with smoothing re-estimated along the way.
//!
//! The output is linear in the last layer and in the linear columns: for these a step is their exact least-squares
//! solution, so that the joint step includes what variable projection would do for them.

use crate::numerics::products::norm;
use std::ops::Range;

use crate::kan::network::dense::Cholesky;
use crate::kan::training::dataset::{Dataset, row_count};
use crate::kan::training::jacobian::NormalEquations;
use crate::kan::training::model::{Model, Unknowns};
use crate::kan::training::outcome::{Convergence, Status, Step};
use crate::kan::training::penalty::{Penalty, reestimate};
use crate::kan::training::settings::{Monitor, Settings, Smoothing};
use crate::kan::training::sparsity::SparsityPenalty;

/// SparsityPenalty towards zero, relative to the mean curvature, that decides between equivalent parameters.
const RIDGE: f64 = 1e-9;

/// Trials of one step, each ten times more damped at the end, before giving up.
const TRIALS: usize = 12;

/// Steps without progress after which the iteration has converged.
const PATIENCE: usize = 3;

/// First strength of estimated smoothing per residual variance: smoother than most data turn out to need, since it is
/// easier to let activations bend than to straighten them out again.
pub(in crate::kan) const SMOOTHING_START: f64 = 100.0;

/// Minimises over all trained parameters of the model; leaves the best found in it.
pub(in crate::kan) fn minimise(
    model: &mut Model,
    dataset: &Dataset,
    rows: &[Range<usize>],
    settings: &Settings,
    monitor: &mut Monitor,
) -> (Convergence, f64) {
    let unknowns = Unknowns::of(model, settings.with_base);
    let samples = row_count(rows);
    let start = match settings.smoothing {
        Smoothing::None => 0.0,
        Smoothing::Fixed(strength) => strength * samples as f64,
        Smoothing::Estimated => SMOOTHING_START * settings.noise_variance,
    };
    let mut penalties = Penalty::smoothness(model, &unknowns, start);
    let sparsity = SparsityPenalty::of(model, &unknowns, settings.sparsity, samples as f64);
    let mut values = unknowns.read(model);
    let mut normal = NormalEquations::of(model, &unknowns, dataset, rows);
    let mut damping = 1e-3;
    let mut report = Convergence { status: Status::StepLimit, steps: 0, evaluations: 1, gradient_norm: f64::NAN };
    let mut score;
    let mut idle = 0;

    loop {
        let ridge = ridge_of(&normal);
        let (mut matrix, mut gradient) = penalised(&normal, &penalties, ridge, &values);
        let mut degrees_of_freedom = None;
        score = normal.residual_sum / samples as f64;
        if settings.smoothing == Smoothing::Estimated
            && let Some(factor) = Cholesky::new(&matrix, normal.size)
        {
            let found = reestimate(&mut penalties, &normal, &factor, ridge, &values, samples);
            // Generalised cross-validation (Craven and Wahba, 1979).
            score /= (1.0 - found / samples as f64).max(0.1).powi(2);
            degrees_of_freedom = Some(found);
            (matrix, gradient) = penalised(&normal, &penalties, ridge, &values);
        }
        sparsity.add_gradient(&values, 1.0, &mut gradient);
        sparsity.add_curvature(&values, normal.size, &mut matrix);
        report.gradient_norm = 2.0 * norm(&gradient) / samples as f64;
        let step = Step {
            step: report.steps,
            loss: model.physical_loss(normal.residual_sum, samples),
            validation_loss: None,
            gradient_norm: report.gradient_norm,
            degrees_of_freedom,
        };
        if monitor.observe(step, model, dataset) {
            report.status = Status::ValidationRose;
            break;
        }
        if idle >= PATIENCE {
            report.status = Status::Converged;
            break;
        }
        if report.steps >= settings.steps {
            break;
        }

        let penalty = |values: &[f64]| {
            let smooth: f64 = penalties.iter().map(|penalty| penalty.value(values)).sum();
            smooth + sparsity.value(values) + ridge * values.iter().map(|v| v * v).sum::<f64>()
        };
        let before = normal.residual_sum + penalty(&values);
        let mut accepted = None;
        for _ in 0..TRIALS {
            let mut damped = matrix.clone();
            let floor = 1e-3 * mean_diagonal(&normal).max(f64::MIN_POSITIVE);
            for i in 0..normal.size {
                let diagonal = &mut damped[i * normal.size + i];
                *diagonal += damping * diagonal.max(floor);
            }
            let Some(factor) = Cholesky::new(&damped, normal.size) else {
                damping *= 10.0;
                continue;
            };
            let step = factor.solve(&gradient);
            let candidate: Vec<f64> = values.iter().zip(&step).map(|(value, s)| value - s).collect();
            unknowns.write(&candidate, model);
            let after = model.residual_sum(dataset, rows) + penalty(&candidate);
            report.evaluations += 1;
            let promised = promised_fall(&matrix, &gradient, &step);
            if after.is_finite() && after <= before {
                let ratio = (before - after) / promised.max(f64::MIN_POSITIVE);
                damping = (damping
                    * if ratio > 0.75 {
                        0.1
                    } else if ratio > 0.25 {
                        0.5
                    } else {
                        2.0
                    })
                .max(1e-12);
                accepted = Some((candidate, (before - after) / before.max(f64::MIN_POSITIVE)));
                break;
            }
            damping *= 10.0;
        }
        let Some((candidate, fall)) = accepted else {
            unknowns.write(&values, model);
            report.status = if idle > 0 { Status::Converged } else { Status::Stalled };
            break;
        };
        values = candidate;
        report.steps += 1;
        normal = NormalEquations::of(model, &unknowns, dataset, rows);
        idle = if fall < settings.tolerance { idle + 1 } else { 0 };
    }
    monitor.restore_best(model);
    (report, score)
}

/// Matrix (upper triangle) and half gradient of residuals, penalties and ridge together.
pub(in crate::kan) fn penalised(
    normal: &NormalEquations,
    penalties: &[Penalty],
    ridge: f64,
    values: &[f64],
) -> (Vec<f64>, Vec<f64>) {
    let (mut matrix, mut gradient) = (normal.matrix.clone(), normal.gradient.clone());
    for penalty in penalties {
        penalty.add_gradient(values, 1.0, &mut gradient);
        penalty.add_curvature(normal.size, &mut matrix);
    }
    for (i, value) in values.iter().enumerate() {
        matrix[i * normal.size + i] += ridge;
        gradient[i] += ridge * value;
    }
    (matrix, gradient)
}

/// Fall of the quadratic model, `2 g's - s'As` for the step `-s`.
fn promised_fall(matrix: &[f64], gradient: &[f64], step: &[f64]) -> f64 {
    let n = step.len();
    let mut quadratic = 0.0;
    for i in 0..n {
        let row = &matrix[i * n..(i + 1) * n];
        let off: f64 = row[i + 1..].iter().zip(&step[i + 1..]).map(|(a, s)| a * s).sum();
        quadratic += step[i] * (row[i] * step[i] + 2.0 * off);
    }
    2.0 * gradient.iter().zip(step).map(|(g, s)| g * s).sum::<f64>() - quadratic
}

/// Weight of the penalty on the size of the coefficients.
pub(in crate::kan) fn ridge_of(normal: &NormalEquations) -> f64 {
    RIDGE * mean_diagonal(normal).max(f64::MIN_POSITIVE)
}

fn mean_diagonal(normal: &NormalEquations) -> f64 {
    let sum: f64 = (0..normal.size).map(|i| normal.matrix[i * normal.size + i]).sum();
    sum / normal.size.max(1) as f64
}
