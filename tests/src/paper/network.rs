//! P3 and P5: the network `[1,5,1]` that knows no form, clean and under noise.

use std::slice::from_ref;
use std::time::Instant;

use frikan_trainer::kan::{Blocks, Dataset, FitOptions, FitResult, Random, Smoothing, fit};

use super::{JOINTS, NOISE, SAMPLES, Samples, r2, samples};

/// A trained network with the samples that it learnt from.
#[derive(Clone, Debug)]
pub struct Learnt {
    /// What it was trained on.
    pub samples: Samples,
    /// Velocities of the other samples on which it is judged, rad/s.
    pub test_velocity: Vec<f64>,
    /// The fit.
    pub fit: FitResult,
    /// Root mean square error against the clean truth on other samples, N m: after a third, two thirds and all steps.
    pub rmse: [f64; 3],
    /// R2 against the clean truth on other samples.
    pub r2: f64,
    /// Time of the training.
    pub seconds: f64,
}

/// The settings for clean data: activations as they come, trained until nothing is gained.
#[must_use]
pub fn clean_options(seed: u64) -> FitOptions {
    FitOptions { seed, restarts: 3, steps: 80, tolerance: 1e-3, ..noisy_options(seed) }
}

/// The settings for data with noise: smoothing estimated from them.
#[must_use]
pub fn noisy_options(seed: u64) -> FitOptions {
    let architecture = "[1,5,1]".parse().expect("a shape");
    FitOptions { seed, smoothing: Smoothing::Estimated, ..FitOptions::new(architecture) }
}

/// The settings of a short training: one start, a few steps.
#[must_use]
pub fn short_options(seed: u64) -> FitOptions {
    FitOptions { steps: 8, ..noisy_options(seed) }
}

/// Trains on one draw of a joint; `share` is the noise as a share of the range, zero for clean data.
#[must_use]
pub fn learn(joint: usize, share: f64, seed: u64) -> Learnt {
    learn_with(joint, share, seed, &if share > 0.0 { noisy_options(seed) } else { clean_options(seed) })
}

/// As [`learn`], with other settings.
///
/// # Panics
/// When the samples cannot be used, which they can.
#[must_use]
pub fn learn_with(joint: usize, share: f64, seed: u64, options: &FitOptions) -> Learnt {
    let mut random = Random::new(40_000 + seed, joint as u64);
    let samples = samples(JOINTS[joint], SAMPLES, share, &mut random);
    let test = super::samples(JOINTS[joint], 2 * SAMPLES, 0.0, &mut random);
    let blocks = Blocks::default();
    let data = Dataset { inputs: from_ref(&samples.velocity), target: &samples.noisy, linear: &[], blocks: &blocks };
    let start = Instant::now();
    let fit = fit(&data, options, &|_| ()).expect("usable samples");
    let seconds = start.elapsed().as_secs_f64();
    let error = |share: f64| {
        let predicted = fit.network_at(share).evaluate_columns(from_ref(&test.velocity));
        let sum: f64 = predicted.iter().zip(&test.clean).map(|(p, t)| (p - t).powi(2)).sum();
        (sum / predicted.len() as f64).sqrt()
    };
    Learnt {
        rmse: [error(1.0 / 3.0), error(2.0 / 3.0), error(1.0)],
        r2: r2(&test.clean, &fit.network.evaluate_columns(from_ref(&test.velocity))),
        samples,
        test_velocity: test.velocity,
        fit,
        seconds,
    }
}

/// R2 against the clean truth over draws of a joint under its noise.
#[must_use]
pub fn noisy_r2(joint: usize, seeds: u64) -> Vec<f64> {
    (0..seeds).map(|seed| learn(joint, NOISE[joint] / 2.0, seed).r2).collect()
}
