//! The confidence band of a trained network: standard errors of its output from the penalised least-squares fit.

use crate::kan::network::dense::{Cholesky, dot};
use crate::kan::network::error::KanError;
use crate::kan::network::layers::Network;
use crate::kan::training::dataset::{Blocks, Dataset, row_count};
use crate::kan::training::jacobian::{NormalEquations, derivatives};
use crate::kan::training::model::{Model, Unknowns};
use crate::kan::training::optimisers::gauss_newton::{SMOOTHING_START, penalised, ridge_of};
use crate::kan::training::penalty::{Penalty, reestimate};

/// Rounds in which the smoothing is estimated for the network as it stands.
const ROUNDS: usize = 20;

/// Standard errors of the network's output at `points` (one column per input), unit of the target. The covariance is that of
/// the coefficients given the estimated smoothing, which covers the bias of smoothing on average over the inputs (Wahba 1983,
/// Nychka 1988). Residuals are taken as independent; where they are correlated over `m` samples, the errors grow by `sqrt(m)`.
///
/// # Errors
/// [`KanError`] when the data do not belong to the network.
pub fn standard_errors(
    network: &Network,
    linear_coefficients: &[f64],
    dataset: &Dataset,
    points: &[Vec<f64>],
) -> Result<Vec<f64>, KanError> {
    dataset.check(network.inputs.len())?;
    let rows = dataset.training_rows();
    let samples = row_count(&rows);
    let model = Model::resumed(network.clone(), linear_coefficients, dataset, &rows);
    let unknowns = Unknowns::of(&model, false);
    let values = unknowns.read(&model);
    let normal = NormalEquations::of(&model, &unknowns, dataset, &rows);
    let ridge = ridge_of(&normal);
    let first = SMOOTHING_START * normal.residual_sum / samples as f64;
    let mut penalties = Penalty::smoothness(&model, &unknowns, first);
    let mut freedom = 0.0;
    let mut factor = None;
    for _ in 0..ROUNDS {
        // A smoothing so strong that rounding hides the data beside it changes nothing more: the one before stands.
        let Some(made) = Cholesky::new(&penalised(&normal, &penalties, ridge, &values).0, normal.size) else { break };
        freedom = reestimate(&mut penalties, &normal, &made, ridge, &values, samples);
        factor = Some(made);
    }
    let count = points.first().map_or(0, Vec::len);
    let Some(factor) = factor else { return Ok(vec![f64::INFINITY; count]) };
    let variance = normal.residual_sum / (samples as f64 - freedom).max(1.0);
    let nothing = vec![0.0; count];
    let linear = vec![nothing.clone(); dataset.linear.len()];
    let at = Dataset { inputs: points, target: &nothing, linear: &linear, blocks: &Blocks::default() };
    let error = |slopes: Vec<f64>| network.output.width * (variance * dot(&slopes, &factor.solve(&slopes))).sqrt();
    Ok(derivatives(&model, &unknowns, &at).into_iter().map(error).collect())
}

#[cfg(test)]
mod tests {
    use std::slice::from_ref;

    use super::*;
    use crate::kan::{FitOptions, Random, fit};

    /// Averaged over the input and over draws, the 95 % band holds the truth as often as it says.
    #[test]
    fn the_band_covers_the_truth_at_its_rate() {
        let law = |v: f64| (5.0 + 3.0 * (-(v / 0.3).abs()).exp()) * (12.0 * v).tanh() + 2.0 * v;
        let points: Vec<f64> = (0..=80).map(|i| -0.95 + 1.9 * f64::from(i) / 80.0).collect();
        let blocks = Blocks::default();
        let (mut inside, mut all) = (0, 0);
        for seed in 0..12 {
            let mut random = Random::new(seed, 0);
            let v: Vec<f64> = (0..600).map(|_| random.uniform(-1.0, 1.0)).collect();
            let target: Vec<f64> = v.iter().map(|v| law(*v) + 0.5 * random.normal()).collect();
            let dataset = Dataset { inputs: from_ref(&v), target: &target, linear: &[], blocks: &blocks };
            let fitted = fit(&dataset, &FitOptions::new("[1,5,1]".parse().unwrap()), &|_| {}).unwrap();
            let errors = standard_errors(&fitted.network, &[], &dataset, from_ref(&points)).unwrap();
            for (x, error) in points.iter().zip(&errors) {
                inside += usize::from((fitted.network.evaluate(&[*x]) - law(*x)).abs() <= 1.96 * error);
                all += 1;
            }
        }
        let rate = inside as f64 / all as f64;
        println!("inside the 95 % band: {rate:.3}");
        assert!((0.88..=0.99).contains(&rate), "{rate}");
    }
}
