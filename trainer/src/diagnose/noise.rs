//! The noise model: autoregressive colour and a variance that depends on the state.
//!
//! e = A(L)^-1 sigma(x) w with the order of A by the Bayesian information criterion and log sigma^2 linear in the state.

use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Largest order of the autoregression.
const LARGEST_ORDER: usize = 12;
/// Mean of the logarithm of a squared standard normal variable.
const LOG_CHI_SQUARE_MEAN: f64 = -1.270_362_8;

/// A fitted noise model.
#[derive(Clone, Debug)]
pub struct Noise {
    /// Coefficients a_1.. of A(L) = 1 - a_1 L - a_2 L^2 ...
    pub autoregression: Vec<f64>,
    /// Standard deviation of the innovation at each row.
    pub deviation: Vec<f64>,
    /// Root mean square of the coloured residual from which it was fitted.
    pub rms: f64,
}

impl Noise {
    /// White noise of unit variance over `rows`: what is assumed before anything is known.
    pub fn white(rows: usize) -> Self {
        Self { autoregression: Vec::new(), deviation: vec![1.0; rows], rms: 1.0 }
    }

    /// Fits colour and variance to a residual. `runs` are the stretches of consecutive rows; `features` are columns on
    /// which log sigma^2 depends linearly (a constant is added).
    pub fn fit(residual: &[f64], runs: &[Range<usize>], features: &[Vec<f64>]) -> Self {
        let autoregression = autoregression(residual, runs);
        let innovation = whiten_colour(residual, runs, &autoregression);
        let deviation = deviation(&innovation, runs, autoregression.len(), features);
        let count: usize = runs.iter().map(|run| run.len()).sum();
        let energy: f64 = runs.iter().flat_map(|run| &residual[run.clone()]).map(|e| e * e).sum();
        Self { autoregression, deviation, rms: (energy / count.max(1) as f64).sqrt() }
    }

    /// Applies `sigma^-1 A(L)` to a column, in place. Rows within the order of a run's start become zero.
    pub fn whiten(&self, column: &mut [f64], runs: &[Range<usize>]) {
        let order = self.autoregression.len();
        for run in runs {
            for i in run.clone().rev() {
                column[i] = if i < run.start + order {
                    0.0
                } else {
                    let coloured: f64 =
                        self.autoregression.iter().enumerate().map(|(k, a)| a * column[i - k - 1]).sum();
                    (column[i] - coloured) / self.deviation[i]
                };
            }
        }
    }

    /// Number of rows that keep information after whitening.
    pub fn rows(&self, runs: &[Range<usize>]) -> usize {
        runs.iter().map(|run| run.len().saturating_sub(self.autoregression.len())).sum()
    }
}

/// Autoregression by the Levinson recursion on the pooled autocovariance (always stable), order by BIC.
fn autoregression(residual: &[f64], runs: &[Range<usize>]) -> Vec<f64> {
    let count: usize = runs.iter().map(|run| run.len()).sum();
    let covariance: Vec<f64> = (0..=LARGEST_ORDER)
        .map(|lag| {
            runs.iter()
                .map(|run| (run.start + lag..run.end).map(|i| residual[i] * residual[i - lag]).sum::<f64>())
                .sum()
        })
        .collect();
    if covariance[0] <= 0.0 || count < 10 * LARGEST_ORDER {
        return Vec::new();
    }
    let mut coefficients: Vec<f64> = Vec::new();
    let mut error = covariance[0];
    let (mut best, mut best_criterion) = (Vec::new(), count as f64 * error.ln());
    for order in 1..=LARGEST_ORDER {
        let predicted: f64 = coefficients.iter().enumerate().map(|(k, a)| a * covariance[order - 1 - k]).sum();
        let reflection = (covariance[order] - predicted) / error;
        let mut longer: Vec<f64> =
            (0..order - 1).map(|k| coefficients[k] - reflection * coefficients[order - 2 - k]).collect();
        longer.push(reflection);
        coefficients = longer;
        error *= 1.0 - reflection * reflection;
        if error <= 1e-12 * covariance[0] {
            break;
        }
        let criterion = count as f64 * error.ln() + order as f64 * (count as f64).ln();
        if criterion < best_criterion {
            (best, best_criterion) = (coefficients.clone(), criterion);
        }
    }
    best
}

fn whiten_colour(residual: &[f64], runs: &[Range<usize>], autoregression: &[f64]) -> Vec<f64> {
    let mut innovation = vec![0.0; residual.len()];
    for run in runs {
        for i in run.start + autoregression.len()..run.end {
            innovation[i] =
                residual[i] - autoregression.iter().enumerate().map(|(k, a)| a * residual[i - k - 1]).sum::<f64>();
        }
    }
    innovation
}

/// Standard deviation of the innovation, log-linear in the features; rescaled so that the whitened variance is one.
fn deviation(innovation: &[f64], runs: &[Range<usize>], order: usize, features: &[Vec<f64>]) -> Vec<f64> {
    let rows: Vec<usize> = runs.iter().flat_map(|run| run.start + order..run.end).collect();
    let energy: f64 = rows.iter().map(|&i| innovation[i] * innovation[i]).sum();
    let mean = (energy / rows.len().max(1) as f64).max(f64::MIN_POSITIVE);
    let flat = vec![mean.sqrt(); innovation.len()];
    let width = features.len() + 1;
    if rows.len() < 50 * width {
        return flat;
    }
    let mut normal = DMatrix::<f64>::zeros(width, width);
    let mut right = DVector::<f64>::zeros(width);
    let row_of = |i: usize| -> Vec<f64> { std::iter::once(1.0).chain(features.iter().map(|f| f[i])).collect() };
    for &i in &rows {
        let x = row_of(i);
        // The floor keeps one lucky zero from pulling the logarithm down.
        let log_square = (innovation[i] * innovation[i]).max(1e-6 * mean).ln() - LOG_CHI_SQUARE_MEAN;
        for a in 0..width {
            right[a] += x[a] * log_square;
            for b in 0..width {
                normal[(a, b)] += x[a] * x[b];
            }
        }
    }
    let ridge = 1e-6 * normal.trace();
    for a in 0..width {
        normal[(a, a)] += ridge;
    }
    let Some(factor) = normal.cholesky() else { return flat };
    let weights = factor.solve(&right);
    let log_mean = mean.ln();
    let mut deviation: Vec<f64> = (0..innovation.len())
        .map(|i| {
            let log_square: f64 = row_of(i).iter().zip(weights.iter()).map(|(x, w)| x * w).sum();
            (0.5 * log_square.clamp(log_mean - 4.0, log_mean + 4.0)).exp()
        })
        .collect();
    let scale = (rows.iter().map(|&i| (innovation[i] / deviation[i]).powi(2)).sum::<f64>() / rows.len() as f64).sqrt();
    deviation.iter_mut().for_each(|d| *d *= scale);
    deviation
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;

    #[test]
    fn coloured_state_dependent_noise_becomes_white_with_unit_variance() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let count = 20_000;
        let feature: Vec<f64> = (0..count).map(|i| (i as f64 * 0.01).sin().abs()).collect();
        let mut series = vec![0.0; count];
        let mut before = [0.0; 2];
        for i in 0..count {
            let e = 0.3 * (0.5 * 1.5 * feature[i]).exp() * crate::diagnose::random::normal(&mut random);
            let value = 1.2 * before[0] - 0.4 * before[1] + e;
            before = [value, before[0]];
            series[i] = value;
        }
        let runs = vec![0..count];
        let noise = Noise::fit(&series, &runs, std::slice::from_ref(&feature));
        assert!((noise.autoregression[0] - 1.2).abs() < 0.05, "{:?}", noise.autoregression);
        noise.whiten(&mut series, &runs);
        let split = |low: bool| -> f64 {
            let part: Vec<f64> =
                (20..count).filter(|&i| (feature[i] < 0.5) == low).map(|i| series[i] * series[i]).collect();
            part.iter().sum::<f64>() / part.len() as f64
        };
        assert!((split(true) - 1.0).abs() < 0.05 && (split(false) - 1.0).abs() < 0.05);
        let lagged: f64 = series.windows(2).map(|w| w[0] * w[1]).sum::<f64>() / count as f64;
        assert!(lagged.abs() < 0.03);
    }
}
