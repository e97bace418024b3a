//! Siblings by the normal-normal model (Efron and Morris 1973): each has a value of its own, drawn from `N(mean, spread^2)`, and is
//! measured with a standard error. Mean and spread are medians, so that the joints that differ do not widen what they are held against.

use statrs::distribution::{ContinuousCDF, StudentsT};

use crate::numerics::statistics::DEVIATION_PER_MEDIAN;

/// Fewest siblings that have a spread.
const FEWEST: usize = 4;

/// Efficiency of the median magnitude as a measure of spread (Rousseeuw and Croux 1993): so many degrees of freedom a sibling.
pub(super) const EFFICIENCY: f64 = 0.37;

/// Variance of a median over that of a mean, of normal values.
const MEDIAN_VARIANCE: f64 = std::f64::consts::FRAC_PI_2;

/// Most rounds of mean and spread in turn; a few do.
const ROUNDS: usize = 12;

/// Halvings of the interval in which the spread lies.
const HALVINGS: usize = 40;

/// A measured value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Its standard error; zero where it is not known.
    pub error: f64,
}

/// What siblings have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Siblings {
    /// The typical value.
    pub mean: f64,
    /// Standard deviation of the siblings' own values about it, errors of measurement apart.
    pub spread: f64,
    /// How many there are.
    pub count: usize,
}

/// How far a joint lies from its siblings.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Departure {
    /// In standard deviations of what a sibling may show; positive above.
    pub deviations: f64,
    /// Probability that a joint like its siblings lies so far away, to either side.
    pub p: f64,
}

impl Siblings {
    /// Of the values of several joints; `None` where there are too few, or they have no spread at all.
    #[must_use]
    pub fn of(estimates: &[Estimate]) -> Option<Self> {
        if estimates.len() < FEWEST {
            return None;
        }
        let mut siblings = Self { mean: 0.0, spread: 0.0, count: estimates.len() };
        for _ in 0..ROUNDS {
            let last = siblings;
            siblings.mean = weighted_median(estimates.iter().map(|e| (e.value, 1.0 / siblings.scale_or_one(e))));
            siblings.spread = spread(estimates, siblings.mean);
            if siblings == last {
                break;
            }
        }
        estimates.iter().any(|e| siblings.scale(e) > 0.0).then_some(siblings)
    }

    /// Standard deviation of what is measured of a sibling about the mean.
    fn scale(&self, estimate: &Estimate) -> f64 {
        self.spread.hypot(estimate.error)
    }

    /// The same as a weight, which must not be infinite.
    fn scale_or_one(&self, estimate: &Estimate) -> f64 {
        match self.scale(estimate) {
            scale if scale > 0.0 => scale,
            _ => 1.0,
        }
    }

    /// What is to be expected of a joint, given its measurement and its siblings.
    #[must_use]
    pub fn shrunk(&self, estimate: &Estimate) -> Estimate {
        let [own, shared] = [estimate.error.powi(2), self.spread.powi(2)];
        if own + shared == 0.0 {
            return *estimate;
        }
        let trust = shared / (own + shared);
        Estimate { value: self.mean + trust * (estimate.value - self.mean), error: (trust * own).sqrt() }
    }

    /// How far a joint lies from its siblings: Student's t, for mean and spread come from so many siblings only. `None` where neither
    /// spread nor error are known.
    #[must_use]
    pub fn departure(&self, estimate: &Estimate) -> Option<Departure> {
        let count = self.count as f64;
        let scale = self.scale(estimate) * (1.0 + MEDIAN_VARIANCE / count).sqrt();
        if scale <= 0.0 || !scale.is_finite() {
            return None;
        }
        let deviations = (estimate.value - self.mean) / scale;
        let freedom = (EFFICIENCY * (count - 1.0)).max(1.0);
        Some(Departure { deviations, p: two_sided(deviations, freedom) })
    }
}

/// Probability of so many standard deviations or more to either side.
pub(super) fn two_sided(deviations: f64, freedom: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom).map_or(1.0, |t| (2.0 * t.sf(deviations.abs())).min(1.0))
}

/// The spread with which the median magnitude of the departures is that of a normal variable.
fn spread(estimates: &[Estimate], mean: f64) -> f64 {
    let typical = |spread: f64| {
        let scaled = estimates.iter().map(|e| match spread.hypot(e.error) {
            scale if scale > 0.0 => ((e.value - mean) / scale).abs(),
            _ if e.value == mean => 0.0,
            _ => f64::INFINITY,
        });
        DEVIATION_PER_MEDIAN * weighted_median(scaled.map(|departure| (departure, 1.0)))
    };
    if typical(0.0) <= 1.0 {
        return 0.0;
    }
    let furthest = estimates.iter().map(|e| (e.value - mean).abs()).fold(0.0, f64::max);
    let (mut low, mut high) = (0.0, 2.0 * DEVIATION_PER_MEDIAN * furthest);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if typical(middle) > 1.0 { low = middle } else { high = middle }
    }
    high
}

/// The value with half of the weight to either side; the middle between two where the halves are exact.
pub(super) fn weighted_median(values: impl Iterator<Item = (f64, f64)>) -> f64 {
    let mut sorted: Vec<(f64, f64)> = values.collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let total: f64 = sorted.iter().map(|(_, weight)| weight).sum();
    let mut before = 0.0;
    for (index, &(value, weight)) in sorted.iter().enumerate() {
        before += weight;
        if 2.0 * before > total {
            return value;
        }
        if 2.0 * before == total {
            return sorted.get(index + 1).map_or(value, |next| 0.5 * (value + next.0));
        }
    }
    sorted.last().map_or(0.0, |last| last.0)
}
