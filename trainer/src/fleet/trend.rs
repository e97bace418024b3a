//! How a quantity changes with the date: a line a joint, the scatter between recordings of one joint shared by all siblings.

use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::siblings::{EFFICIENCY, Estimate, two_sided, weighted_median};

/// Fewest recordings of a joint for a line that says more than it assumes.
const FEWEST: usize = 3;

/// Halvings of the interval in which the scatter lies.
const ROUNDS: usize = 60;

/// A quantity on one day.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dated {
    /// Day, from any one on.
    pub day: f64,
    /// The quantity.
    pub value: f64,
}

/// The line of one joint.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trend {
    /// Change a day.
    pub slope: Estimate,
    /// Probability of such a slope where nothing changes.
    pub p: f64,
}

struct Line {
    slope: f64,
    /// Sum of squares of the days about their mean.
    leverage: f64,
    /// Sum of squares of what the line leaves.
    rest: f64,
    freedom: f64,
}

/// The trend of every joint of a kind; `None` for those with too few dates.
pub(super) fn trends(joints: &[Vec<Dated>]) -> Vec<Option<Trend>> {
    let lines: Vec<Option<Line>> = joints.iter().map(|dated| line(dated)).collect();
    let known: Vec<&Line> = lines.iter().flatten().collect();
    let variance = variance(&known);
    let freedom = (EFFICIENCY * known.iter().map(|line| line.freedom).sum::<f64>()).max(1.0);
    let trend = |line: Line| {
        let error = (variance / line.leverage).sqrt();
        let p = if error > 0.0 { two_sided(line.slope / error, freedom) } else { 1.0 };
        Trend { slope: Estimate { value: line.slope, error }, p }
    };
    lines.into_iter().map(|line| line.map(trend)).collect()
}

fn line(dated: &[Dated]) -> Option<Line> {
    let count = dated.len() as f64;
    let mean = |of: fn(&Dated) -> f64| dated.iter().map(of).sum::<f64>() / count;
    let (day, value) = (mean(|d| d.day), mean(|d| d.value));
    let leverage: f64 = dated.iter().map(|d| (d.day - day).powi(2)).sum();
    if dated.len() < FEWEST || leverage <= 0.0 {
        return None;
    }
    let slope = dated.iter().map(|d| (d.day - day) * (d.value - value)).sum::<f64>() / leverage;
    let rest = dated.iter().map(|d| (d.value - value - slope * (d.day - day)).powi(2)).sum();
    Some(Line { slope, leverage, rest, freedom: count - 2.0 })
}

/// Variance of a recording about the line of its joint: that with which half of the joints leave more than by chance, so that joints
/// that jump do not widen it.
fn variance(lines: &[&Line]) -> f64 {
    let high = lines.iter().map(|line| line.rest).fold(0.0, f64::max);
    let half_leave_less = |variance: f64| {
        let shares = lines
            .iter()
            .map(|line| ChiSquared::new(line.freedom).map_or(0.5, |chi_squared| chi_squared.cdf(line.rest / variance)));
        weighted_median(shares.map(|share| (share, 1.0))) <= 0.5
    };
    // The middle of a chi-squared variable of one degree of freedom is 0.45.
    let (mut low, mut high) = (0.0, high / 0.4);
    for _ in 0..ROUNDS {
        let middle = 0.5 * (low + high);
        if middle > 0.0 && half_leave_less(middle) { high = middle } else { low = middle }
    }
    high
}
