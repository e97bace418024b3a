//! The experiments of the paper (Wang, Rabczuk & Liu), run again.

pub mod known_form;
pub mod network;
pub mod page;
pub mod robot;
pub mod spline_peer;
pub mod symbolic;

pub use crate::published::{JOINTS, NOISE, SAMPLES, SMOOTHING, Samples, friction, samples, with_noise};

/// Share of the variance of `truth` that `predicted` explains.
#[must_use]
pub fn r2(truth: &[f64], predicted: &[f64]) -> f64 {
    let mean = truth.iter().sum::<f64>() / truth.len() as f64;
    let missed: f64 = truth.iter().zip(predicted).map(|(t, p)| (t - p).powi(2)).sum();
    let spread: f64 = truth.iter().map(|t| (t - mean).powi(2)).sum();
    1.0 - missed / spread
}

/// The middle of values, the mean of the two middle ones of an even number.
#[must_use]
pub fn median(values: &[f64]) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let (below, above) = ((sorted.len() - 1) / 2, sorted.len() / 2);
    0.5 * (sorted[below] + sorted[above])
}

/// How much of the experiments to run.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Draws of the network experiments.
    pub seeds: u64,
    /// Draws by which intervals are checked.
    pub coverage: u64,
}

impl Effort {
    /// As the published tables.
    pub const FULL: Self = Self { seeds: 20, coverage: 200 };
    /// Enough to see that every experiment runs and comes out.
    pub const SHORT: Self = Self { seeds: 2, coverage: 5 };
}
