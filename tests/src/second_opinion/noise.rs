//! Noise of a torque: white, or a first-order process.

use super::random::Random;

/// `count` deviates of standard deviation `deviation`, each correlated with the one before by `correlation` (0 is white).
pub fn noise(count: usize, deviation: f64, correlation: f64, random: &mut Random) -> Vec<f64> {
    let fresh = (1.0 - correlation * correlation).sqrt();
    let mut state = random.normal();
    let mut next = |index: usize| {
        if index > 0 {
            state = correlation * state + fresh * random.normal();
        }
        deviation * state
    };
    (0..count).map(&mut next).collect()
}

/// Correlation of neighbouring samples of a process with a time constant of 12 ms, 20 ms where samples are slow.
#[must_use]
pub fn correlation(period_s: f64) -> f64 {
    let time_constant_s = if period_s < 0.005 { 0.012 } else { 0.02 };
    (-period_s / time_constant_s).exp()
}
