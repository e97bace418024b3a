//! Noise of a recorded position beside its steps: how large it is and how it hangs together from row to row, and a simulated position with as much.
//!
//! A law of commands, an inertia and a delay all read the position, so that its noise biases them (errors in variables; Fuller 1987). Where a recording
//! is compared with a simulation, one that was measured alike is biased alike.

use nalgebra::{DMatrix, DVector};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

use super::grid::Grid;
use crate::numerics::random::normal;
use crate::numerics::statistics::quantile;
use crate::recording::{Quantity, Recording};

/// Products of the fourth difference's weights 1, -4, 6, -4, 1 so many rows apart, summed: what noise of that correlation has of its variance.
const LAGGED_PRODUCTS: [f64; 5] = [70.0, -56.0, 28.0, -8.0, 1.0];
/// Largest pole that is looked for, and steps to it: noise slower than twenty rows is a motion.
const LARGEST_POLE: f64 = 0.95;
const POLES: u32 = 95;
/// Rows apart at which differences are taken, up to so many.
const MOST_STRIDE: i32 = 8;
/// Powers of the stride with which a motion grows in them: of a smooth one the fourth derivative, and jumps of the acceleration where friction turns over.
const MOTION_POWERS: [i32; 2] = [8, 5];
/// Differences count up to so many of their usual size: an impact is no noise, and heavy tails are.
const MOST_DEVIATIONS: f64 = 8.0;
/// Rows of a stretch for each row of a stride: ten fourth differences one behind the other.
const LEAST_ROWS_OF_STRIDE: i32 = 40;
/// Deviations by which the finest differences have to exceed those of the encoder's steps.
const CLEAR_DEVIATIONS: f64 = 3.0;
/// Parameters that are fitted to the differences: noise, pole and two powers of the motion.
const FITTED: f64 = 4.0;
/// Share of the finest differences that counts as next to no noise.
const LEAST_SHARE: f64 = 1e-6;
/// Seed of the noise that is added: one recording, one answer.
const SEED: u64 = 1;

/// First-order autoregressive noise of a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PositionNoise {
    /// rad2 or m2
    variance: f64,
    /// Correlation of a row with the one before.
    pole: f64,
    period_s: f64,
    /// Step of the encoder, rad or m; 0 where there is none.
    step: f64,
}

impl PositionNoise {
    /// Of a recording; `None` without position and clock.
    pub(crate) fn of(recording: &Recording) -> Option<Self> {
        let time = recording.values(Quantity::Time)?;
        let position = recording.values(Quantity::Position)?;
        let grid = Grid::of(recording, time);
        let longest = grid.segments.iter().max_by_key(|segment| segment.points)?;
        let values = grid.values(longest, time, position);
        let step = recording.health.position_resolution.unwrap_or(0.0);
        let (variance, pole) = variance_and_pole(&values, step);
        Some(Self { variance, pole, period_s: grid.period_s, step })
    }

    /// A recording as it would be measured with this noise and these steps, as far as its position has less of both: once with the noise and once with its
    /// negative, on steps that lie between those of the first. What goes with the noise itself is nothing over both, and what goes with its square, as
    /// bias does, stays (antithetic variates; Hammersley and Morton 1956).
    pub(crate) fn on_both_ways(&self, recording: &Recording) -> [Recording; 2] {
        let own = Self::of(recording);
        let (Some(own), Some(position)) = (own, recording.values(Quantity::Position)) else {
            return [recording.clone(), recording.clone()];
        };
        let pole = self.pole.powf(own.period_s / self.period_s);
        let missing = (self.density() - own.density()).max(0.0);
        let deviation = (missing / own.period_s * (1.0 - pole) / (1.0 + pole)).sqrt();
        let step = if self.step > own.step { self.step } else { 0.0 };
        let mut random = ChaCha8Rng::seed_from_u64(SEED);
        let mut noise = deviation * normal(&mut random);
        let rounded = |position: f64, offset: f64| {
            if step > 0.0 { ((position / step + offset).round() - offset) * step } else { position }
        };
        let measured = position.iter().map(|position| {
            let both = (rounded(position + noise, 0.0), rounded(position - noise, 0.5));
            noise = pole * noise + deviation * (1.0 - pole * pole).sqrt() * normal(&mut random);
            both
        });
        let (one, other): (Vec<f64>, Vec<f64>) = measured.unzip();
        [one, other].map(|position| recording.clone().with_position(position))
    }

    /// Spectral density below the pole, which rates leave as it is, rad2 s or m2 s.
    fn density(&self) -> f64 {
        self.variance * self.period_s * (1.0 + self.pole) / (1.0 - self.pole)
    }
}

/// Deviation of white noise that has as much below the pole as the noise of a position beside its steps, rad or m.
pub(crate) fn white_position_noise(position: &[f64], step: f64) -> f64 {
    let (variance, pole) = variance_and_pole(position, step);
    (variance * (1.0 + pole) / (1.0 - pole)).sqrt()
}

/// Variance of fourth differences so many rows apart, which hold next to nothing of a motion.
fn fourth_difference_variance(values: &[f64], stride: usize) -> f64 {
    let at = |i: usize, lag: usize| values[i + lag * stride];
    let count = values.len().saturating_sub(4 * stride);
    let differences: Vec<f64> =
        (0..count).map(|i| at(i, 0) - 4.0 * at(i, 1) + 6.0 * at(i, 2) - 4.0 * at(i, 3) + at(i, 4)).collect();
    let most = MOST_DEVIATIONS * quantile(differences.iter().map(|x| x.abs()), 0.5) / 0.6745;
    let usual = differences.iter().map(|x| x.abs().min(most).powi(2));
    usual.sum::<f64>() / count.max(1) as f64
}

/// Variance of the fourth difference of noise of variance one with this pole.
fn gain(pole: f64) -> f64 {
    let lagged = (1..).zip(&LAGGED_PRODUCTS[1..]).map(|(lag, product)| 2.0 * product * pole.powi(lag));
    LAGGED_PRODUCTS[0] + lagged.sum::<f64>()
}

/// Variance and pole of the noise of a position, with what a motion adds to its differences: means over the poles by their likelihood, as few of the
/// differences tell a slow noise from a slower one. The steps of an encoder are white and no part of it.
fn variance_and_pole(values: &[f64], step: f64) -> (f64, f64) {
    let strides = 1..=MOST_STRIDE.min(values.len() as i32 / LEAST_ROWS_OF_STRIDE);
    let recorded: Vec<f64> =
        strides.clone().map(|stride| fourth_difference_variance(values, stride as usize)).collect();
    // Relative variance of a mean square of fourth differences: twice the sum of their squared correlations over the rows.
    let squares: f64 = LAGGED_PRODUCTS[1..].iter().map(|product| (product / LAGGED_PRODUCTS[0]).powi(2)).sum();
    let relative_variance = 2.0 * (1.0 + 2.0 * squares) / values.len() as f64;
    let of_steps = LAGGED_PRODUCTS[0] * step * step / 12.0;
    let Some(finest) = recorded.first().filter(|variance| **variance > 0.0 && variance.is_finite()) else {
        return (0.0, 0.0);
    };
    if finest - of_steps < CLEAR_DEVIATIONS * relative_variance.sqrt() * finest {
        return (0.0, 0.0);
    }
    let differences: Vec<f64> =
        recorded.iter().map(|variance| (variance - of_steps).max(LEAST_SHARE * variance)).collect();
    // Shares of the differences, so that every stride counts by its relative error; the error of longer strides is larger.
    let of = |power: &dyn Fn(i32) -> f64| -> Vec<f64> {
        let shares = strides.clone().zip(&differences);
        shares.map(|(stride, variance)| power(stride) / variance / f64::from(stride).sqrt()).collect()
    };
    let motion = MOTION_POWERS.map(|power| of(&|stride| f64::from(stride).powi(power)));
    let target = of(&|stride| differences[stride as usize - 1]);
    let tried: Vec<(f64, f64, f64)> = (0..=POLES)
        .map(|step| {
            let pole = LARGEST_POLE * f64::from(step) / f64::from(POLES);
            let columns = [of(&|stride| gain(pole.powi(stride))), motion[0].clone(), motion[1].clone()];
            let (variance, misfit) = share_of_noise(&columns, &target);
            (pole, variance, misfit / relative_variance)
        })
        .collect();
    let best = tried.iter().map(|(_, _, misfit)| *misfit).fold(f64::INFINITY, f64::min);
    // Where no pole fits, as of a motion with other powers, none is as sure as its noise says.
    let expected = (differences.len() as f64 - FITTED).max(1.0);
    let scale = (best / expected).max(1.0);
    let weights: Vec<f64> = tried.iter().map(|(_, _, misfit)| (-0.5 * (misfit - best) / scale).exp()).collect();
    let mean = |value: &dyn Fn(f64, f64) -> f64| {
        let sum: f64 =
            tried.iter().zip(&weights).map(|((pole, variance, _), weight)| weight * value(*pole, *variance)).sum();
        sum / weights.iter().sum::<f64>()
    };
    let pole = mean(&|pole, _| pole);
    // What acts on a joint is its slow part. A pole at which there is no noise counts as one with next to none.
    let least = LEAST_SHARE * differences[0] / LAGGED_PRODUCTS[0];
    let slow = mean(&|pole, variance| (variance.max(least) * (1.0 + pole) / (1.0 - pole)).ln()).exp();
    (slow * (1.0 - pole) / (1.0 + pole), pole)
}

/// The first of the coefficients, none of them negative, with which columns come closest to a target, and the squares that are left: the best of all
/// sets of columns of which none gets a negative one.
fn share_of_noise(columns: &[Vec<f64>; 3], target: &[f64]) -> (f64, f64) {
    let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut best = (0.0, f64::INFINITY);
    for set in 1_u32..8 {
        let chosen: Vec<&Vec<f64>> =
            (0..3).filter(|place| set & (1 << place) != 0).map(|place| &columns[place]).collect();
        let gram = DMatrix::from_fn(chosen.len(), chosen.len(), |i, j| product(chosen[i], chosen[j]));
        let moments = DVector::from_fn(chosen.len(), |i, _| product(chosen[i], target));
        let Some(solved) = gram.cholesky().map(|factor| factor.solve(&moments)) else { continue };
        let misfit = product(target, target) - solved.dot(&moments);
        if solved.iter().all(|coefficient| *coefficient >= 0.0) && misfit < best.1 {
            best = (if set & 1 == 1 { solved[0] } else { 0.0 }, misfit);
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::Joint;
    use crate::recording::parse;

    /// A swing at so many samples a second under noise of this deviation (rad) and pole.
    fn swing(rate_hz: f64, deviation: f64, pole: f64) -> Recording {
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut noise = 0.0;
        let mut text = String::from("time_s,position_rad,torque_Nm\n");
        for i in 0..8000 {
            let time = f64::from(i) / rate_hz;
            noise = pole * noise + deviation * (1.0 - pole * pole).sqrt() * normal(&mut random);
            let position = 0.8 * (2.3 * time).sin() + 0.2 * (5.1 * time).sin() + noise;
            text += &format!("{time},{position},{}\n", time.sin());
        }
        parse("swing.csv", text.as_bytes(), &Joint::default()).unwrap()
    }

    #[test]
    fn deviation_and_pole_come_back() {
        for (deviation, pole) in [(1e-4, 0.0), (1e-3, 0.3), (1e-3, 0.6), (1e-3, 0.75)] {
            let found = PositionNoise::of(&swing(250.0, deviation, pole)).unwrap();
            assert!((found.variance.sqrt() / deviation - 1.0).abs() < 0.15, "{deviation} {pole}: {found:?}");
            assert!((found.pole - pole).abs() < 0.15, "{deviation} {pole}: {found:?}");
        }
    }

    #[test]
    fn a_position_without_noise_gets_as_much_whatever_its_rate() {
        let noise = PositionNoise::of(&swing(250.0, 5e-4, 0.5)).unwrap();
        for rate_hz in [250.0, 500.0] {
            let exact = swing(rate_hz, 0.0, 0.0);
            let measured = noise.on_both_ways(&exact);
            for measured in &measured {
                let found = PositionNoise::of(measured).unwrap();
                assert!((found.density() / noise.density() - 1.0).abs() < 0.5, "{rate_hz}: {found:?} for {noise:?}");
            }
            let [exact, one, other] =
                [&exact, &measured[0], &measured[1]].map(|of| of.values(Quantity::Position).unwrap());
            let is_middle = |row: usize| (0.5 * (one[row] + other[row]) - exact[row]).abs() <= noise.step + 1e-12;
            assert!((0..exact.len()).all(is_middle));
        }
    }
}
