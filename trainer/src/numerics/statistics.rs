//! Statistics that every room uses.

/// Standard deviations to each side of a 95 % interval of a normal variable.
pub(crate) const NORMAL_95: f64 = 1.96;
/// Standard deviation of normal noise over the median of its magnitude: 1 / (quantile of the normal distribution at 3/4).
pub(crate) const DEVIATION_PER_MEDIAN: f64 = 1.4826;

/// Quantile of finite values by sorting; 0 when there are none.
pub(crate) fn quantile(values: impl Iterator<Item = f64>, share: f64) -> f64 {
    let mut sorted: Vec<f64> = values.filter(|v| v.is_finite()).collect();
    if sorted.is_empty() {
        return 0.0;
    }
    let rank = ((sorted.len() - 1) as f64 * share).round() as usize;
    *sorted.select_nth_unstable_by(rank, f64::total_cmp).1
}

/// Value of which those below and above (value, weight) weigh half at most; `None` of none.
pub(crate) fn weighted_median(values: &[(f64, f64)]) -> Option<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = 0.5 * sorted.iter().map(|(_, weight)| weight).sum::<f64>();
    let mut below = 0.0;
    let reaches_half = |(_, weight): &&(f64, f64)| {
        below += weight;
        below >= half
    };
    sorted.iter().find(reaches_half).map(|(value, _)| *value)
}

/// Root of the mean square; 0 of none.
pub(crate) fn root_mean_square(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

/// The mean; 0 of none.
pub(crate) fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

/// Mean over its standard error.
pub(crate) fn t_statistic(values: &[f64]) -> f64 {
    let count = values.len() as f64;
    let mean = mean(values);
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
    mean / (variance / count).sqrt()
}
