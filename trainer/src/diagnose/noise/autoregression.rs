//! The noise model: autoregressive colour and a variance that depends on the state.
//!
//! e = A(L)^-1 sigma(x) w with the order of A by Akaike's information criterion and log sigma^2 linear in the state.

use crate::diagnose::preparation::states::Prepared;
use crate::numerics::least_squares::rows_in;
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Largest order of the autoregression, of which Akaike's criterion chooses. Chosen by judgement: doubled from twelve
/// when Burg's method came; lower leaves slow colour to the hypotheses, higher costs computing time.
const LARGEST_ORDER: usize = 24;
/// Rows for each coefficient at least. Chosen by judgement: it limits the order in recordings of fewer than 240 rows
/// only; fewer rows let the autoregression take up an effect.
const ROWS_PER_COEFFICIENT: usize = 10;
/// Mean of the logarithm of a squared standard normal variable: -(Euler's constant + ln 2).
const LOG_CHI_SQUARE_MEAN: f64 = -1.270_362_8;

/// A fitted noise model.
#[derive(Clone, Debug)]
pub struct Noise {
    /// Predictors of one row by those before it.
    colour: Colour,
    /// Standard deviation of the innovation at each row.
    pub deviation: Vec<f64>,
    /// Root mean square of the coloured residual from which it was fitted.
    pub rms: f64,
    /// How the deviation depends on the features.
    spread: Spread,
}

/// The autoregression with the predictors of every lower order: near the start of a run there are fewer rows to predict from.
#[derive(Clone, Debug)]
struct Colour {
    /// Coefficients a_1.. of A(L) = 1 - a_1 L - a_2 L^2 ... by order.
    predictors: Vec<Vec<f64>>,
    /// Error of each predictor over that of the last: ratio of standard deviations.
    excess: Vec<f64>,
}

impl Noise {
    /// White noise of a standard deviation over `rows`: what is assumed before anything is known.
    pub fn white(rows: usize, deviation: f64) -> Self {
        Self {
            colour: Colour { predictors: vec![Vec::new()], excess: vec![1.0] },
            deviation: vec![deviation; rows],
            rms: deviation,
            spread: Spread::even(deviation),
        }
    }

    /// Fits colour and variance to a residual. `runs` are the stretches of consecutive rows; `features` are columns on
    /// which log sigma^2 depends linearly (a constant is added).
    pub fn fit(residual: &[f64], runs: &[Range<usize>], features: &[Vec<f64>]) -> Self {
        let colour = Colour::fit(residual, runs);
        let mut innovation = residual.to_vec();
        colour.remove(&mut innovation, runs);
        let spread = Spread::fit(&innovation, runs, features);
        let deviation = (0..innovation.len()).map(|i| spread.at(features, i)).collect();
        let count = rows_in(runs);
        let energy: f64 = runs.iter().flat_map(|run| &residual[run.clone()]).map(|e| e * e).sum();
        Self { colour, deviation, rms: (energy / count.max(1) as f64).sqrt(), spread }
    }

    /// The same noise at other rows, by their features; those that are not given there are zero.
    #[must_use]
    pub(crate) fn at_rows_of(&self, features: &[Vec<f64>]) -> Self {
        let rows = features.first().map_or(0, Vec::len);
        Self { deviation: (0..rows).map(|i| self.spread.at(features, i)).collect(), ..self.clone() }
    }

    /// A column behind `sigma^-1 A(L)`, on the rows of the runs.
    pub fn whitened(&self, column: &[f64], runs: &[Range<usize>]) -> Vec<f64> {
        let mut white = column.to_vec();
        self.whiten(&mut white, runs);
        white
    }

    /// The same in place.
    fn whiten(&self, column: &mut [f64], runs: &[Range<usize>]) {
        self.colour.remove(column, runs);
        for i in runs.iter().flat_map(Range::clone) {
            column[i] /= self.deviation[i];
        }
    }
}

impl Colour {
    /// Burg's method over all runs (Burg 1975): always stable, and not blurred where the runs are short, as the autocovariance is.
    fn fit(residual: &[f64], runs: &[Range<usize>]) -> Self {
        let count = rows_in(runs);
        let (mut forward, mut backward) = (residual.to_vec(), residual.to_vec());
        let mut predictors = vec![Vec::new()];
        let mut errors = vec![1.0];
        let (mut best, mut best_criterion) = (0, 0.0);
        for order in 1..=LARGEST_ORDER.min(count / ROWS_PER_COEFFICIENT) {
            let rows = || runs.iter().flat_map(|run| run.start + order..run.end);
            let (product, power) = rows().fold((0.0, 0.0), |(product, power), i| {
                let (f, b) = (forward[i], backward[i - 1]);
                (product + f * b, power + f * f + b * b)
            });
            let reflection: f64 = if power > 0.0 { 2.0 * product / power } else { break };
            for run in runs {
                for i in (run.start + order..run.end).rev() {
                    let (f, b) = (forward[i], backward[i - 1]);
                    (forward[i], backward[i]) = (f - reflection * b, b - reflection * f);
                }
            }
            let shorter = &predictors[order - 1];
            let mut longer: Vec<f64> =
                (0..order - 1).map(|k| shorter[k] - reflection * shorter[order - 2 - k]).collect();
            longer.push(reflection);
            predictors.push(longer);
            let error: f64 = errors[order - 1] * (1.0 - reflection * reflection);
            if error <= 1e-12 {
                break;
            }
            errors.push(error);
            // Colour that is left counts as evidence, a coefficient too many costs little.
            let criterion = count as f64 * error.ln() + 2.0 * order as f64;
            if criterion < best_criterion {
                (best, best_criterion) = (order, criterion);
            }
        }
        predictors.truncate(best + 1);
        let excess = errors[..=best].iter().map(|error| (error / errors[best]).sqrt()).collect();
        Self { predictors, excess }
    }

    /// Subtracts from each row what those before it in its run predict, in place; at the start of a run scaled to the error of
    /// the last predictor.
    fn remove(&self, column: &mut [f64], runs: &[Range<usize>]) {
        let largest = self.predictors.len() - 1;
        for run in runs {
            for i in run.clone().rev() {
                let order = (i - run.start).min(largest);
                let predicted: f64 =
                    self.predictors[order].iter().enumerate().map(|(k, a)| a * column[i - k - 1]).sum();
                column[i] = (column[i] - predicted) / self.excess[order];
            }
        }
    }
}

/// Standard deviation of the innovation, log-linear in the features.
#[derive(Clone, Debug)]
struct Spread {
    /// Weights of one and of each feature in the logarithm of the variance; empty where it is the same everywhere.
    weights: Vec<f64>,
    /// Logarithm of the mean variance.
    log_mean: f64,
    /// Factor that makes the whitened variance one.
    scale: f64,
}

/// Nats by which the variance of a row may differ from the mean. Chosen by judgement: a factor of 55 either way.
const LARGEST_VARIANCE_NATS: f64 = 4.0;

impl Spread {
    fn even(deviation: f64) -> Self {
        Self { weights: Vec::new(), log_mean: 2.0 * deviation.ln(), scale: 1.0 }
    }

    fn fit(innovation: &[f64], runs: &[Range<usize>], features: &[Vec<f64>]) -> Self {
        let rows: Vec<usize> = runs.iter().flat_map(Range::clone).collect();
        let energy: f64 = rows.iter().map(|&i| innovation[i] * innovation[i]).sum();
        let mean = (energy / rows.len().max(1) as f64).max(f64::MIN_POSITIVE);
        let flat = Self::even(mean.sqrt());
        let width = features.len() + 1;
        if rows.len() < 50 * width {
            return flat;
        }
        let mut normal = DMatrix::<f64>::zeros(width, width);
        let mut right = DVector::<f64>::zeros(width);
        for &i in &rows {
            let x: Vec<f64> = row_of(features, i).collect();
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
        let mut spread =
            Self { weights: factor.solve(&right).iter().copied().collect(), log_mean: mean.ln(), scale: 1.0 };
        let white = rows.iter().map(|&i| (innovation[i] / spread.at(features, i)).powi(2)).sum::<f64>();
        spread.scale = (white / rows.len() as f64).sqrt();
        spread
    }

    /// Deviation at a row of the features.
    fn at(&self, features: &[Vec<f64>], row: usize) -> f64 {
        let log_square: f64 = match self.weights.is_empty() {
            true => self.log_mean,
            false => row_of(features, row).zip(&self.weights).map(|(x, w)| x * w).sum(),
        };
        let nearest = log_square.clamp(self.log_mean - LARGEST_VARIANCE_NATS, self.log_mean + LARGEST_VARIANCE_NATS);
        (0.5 * nearest).exp() * self.scale
    }
}

/// One and the features of a row.
fn row_of(features: &[Vec<f64>], row: usize) -> impl Iterator<Item = f64> {
    std::iter::once(1.0).chain(features.iter().map(move |feature| feature[row]))
}

/// Largest value of a feature of the noise over its mean: a sweep reaches some twelve times its mean acceleration, a
/// glitch more and would bend the fit. Chosen by judgement: anything between the two.
const LARGEST_FEATURE: f64 = 20.0;

/// What the variance of the noise may depend on: |v|, |a|, |tau| and nearness to standstill, each scaled to order one.
pub(crate) fn noise_features(prepared: &Prepared) -> Vec<Vec<f64>> {
    let state = &prepared.state;
    let scaled = |series: Vec<f64>| {
        let mean = series.iter().sum::<f64>() / series.len().max(1) as f64;
        series.iter().map(|v| (v / mean.max(f64::MIN_POSITIVE)).min(LARGEST_FEATURE)).collect::<Vec<f64>>()
    };
    let slow = (0.05 * state.top_speed()).max(3.0 * state.sign_velocity);
    vec![
        scaled(prepared.rows.iter().map(|&i| state.velocity[i].abs()).collect()),
        scaled(prepared.rows.iter().map(|&i| state.acceleration[i].abs()).collect()),
        scaled(prepared.rows.iter().map(|&i| state.torque[i].abs()).collect()),
        prepared.rows.iter().map(|&i| (-(state.velocity[i] / slow).powi(2)).exp()).collect(),
    ]
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
            let e = 0.3 * (0.5 * 1.5 * feature[i]).exp() * crate::numerics::random::normal(&mut random);
            let value = 1.2 * before[0] - 0.4 * before[1] + e;
            before = [value, before[0]];
            series[i] = value;
        }
        let runs = vec![0..count];
        let noise = Noise::fit(&series, &runs, std::slice::from_ref(&feature));
        assert!((noise.colour.predictors[2][0] - 1.2).abs() < 0.05, "{:?}", noise.colour);
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

    #[test]
    fn short_runs_tell_the_colour_and_keep_their_first_rows() {
        let mut random = ChaCha8Rng::seed_from_u64(2);
        let (length, count) = (25, 400);
        let runs: Vec<Range<usize>> = (0..count).map(|run| run * length..(run + 1) * length).collect();
        let mut series = Vec::new();
        for _ in &runs {
            let mut before = [0.0; 2];
            for row in 0..200 + length {
                let value = 1.5 * before[0] - 0.7 * before[1] + crate::numerics::random::normal(&mut random);
                before = [value, before[0]];
                if row >= 200 {
                    series.push(value);
                }
            }
        }
        let noise = Noise::fit(&series, &runs, &[]);
        let [first, second] = noise.colour.predictors[2][..] else { panic!("an order of two") };
        assert!((first - 1.5).abs() < 0.03 && (second + 0.7).abs() < 0.03, "{first} {second}");
        noise.whiten(&mut series, &runs);
        for row in [0, 1, 2, 20] {
            let power = runs.iter().map(|run| series[run.start + row].powi(2)).sum::<f64>() / count as f64;
            assert!((power - 1.0).abs() < 0.25, "row {row} of a run: {power}");
        }
        let sums: Vec<f64> = runs.iter().map(|run| series[run.clone()].iter().sum()).collect();
        let power = sums.iter().map(|sum| sum * sum).sum::<f64>() / (count * length) as f64;
        assert!((power - 1.0).abs() < 0.25, "slow power {power}");
    }
}
