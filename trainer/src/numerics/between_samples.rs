//! The value of an evenly sampled series between its samples.

/// A series between its samples, by the cubic through the two on either side: a straight line would take a tenth of what swings with a
/// seventh of the sampling rate, as an inertia does. Within a sample of an end it is that line, beyond it the last sample.
pub(crate) fn between_samples(series: &[f64], place: f64) -> f64 {
    let last = series.len() - 1;
    let before = (place.max(0.0) as usize).min(last);
    let share = (place - before as f64).clamp(0.0, 1.0);
    if before == 0 || before + 2 > last {
        return series[before] + share * (series[(before + 1).min(last)] - series[before]);
    }
    // Lagrange's polynomial on four equal steps.
    let (since, until) = (share + 1.0, share - 2.0);
    let weights = [
        -share * (share - 1.0) * until / 6.0,
        since * (share - 1.0) * until / 2.0,
        -since * share * until / 2.0,
        since * share * (share - 1.0) / 6.0,
    ];
    weights.iter().zip(&series[before - 1..]).map(|(weight, value)| weight * value).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_samples_a_cubic_is_met_and_beyond_them_the_last_holds() {
        let cubic = |x: f64| 1.0 - 2.0 * x + 0.5 * x * x + 0.25 * x * x * x;
        let series: Vec<f64> = (0..6).map(|i| cubic(f64::from(i))).collect();
        for place in [1.0, 1.3, 2.5, 3.9] {
            assert!((between_samples(&series, place) - cubic(place)).abs() < 1e-12, "{place}");
        }
        assert_eq!(
            [-3.0, 0.0, 5.0, 9.5].map(|place| between_samples(&series, place)),
            [series[0], series[0], series[5], series[5]]
        );
        assert_eq!(between_samples(&series[..1], 0.4), series[0]);
    }
}
