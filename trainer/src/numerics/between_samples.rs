//! What lies between samples: the value of an even series there, and the mean of a smoothed sign over the velocities passed.

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

/// Mean of the hyperbolic tangent over arguments from one to another, which are not the same.
pub(crate) fn mean_tanh(from: f64, to: f64) -> f64 {
    let log_cosh = |x: f64| x.abs() + (-2.0 * x.abs()).exp().ln_1p();
    (log_cosh(to) - log_cosh(from)) / (to - from)
}

/// Mean over velocities from the least to the most of a sign that turns over in a straight line within `width` of zero.
pub(crate) fn mean_clamped(least: f64, most: f64, width: f64) -> f64 {
    let middle = 0.5 * (least + most);
    if most <= -width || least >= width {
        return middle.signum();
    }
    let integral = |v: f64| if v.abs() < width { 0.5 * (v * v / width + width) } else { v.abs() };
    if most > least { (integral(most) - integral(least)) / (most - least) } else { (middle / width).clamp(-1.0, 1.0) }
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

    fn mean(of: impl Fn(f64) -> f64, least: f64, most: f64) -> f64 {
        (0..10_000).map(|k| of(least + (most - least) * (f64::from(k) + 0.5) / 1e4)).sum::<f64>() / 1e4
    }

    #[test]
    fn the_mean_sign_is_that_of_many_velocities() {
        let asked = [(0.1, 0.5, 0.0), (-0.05, 0.2, 0.08), (0.3, 0.1, 0.2), (0.02, 0.0, 0.05), (0.0, 0.1, 0.3)];
        for (middle, span, width) in asked {
            let sign = |v: f64| if width > 0.0 { (v / width).clamp(-1.0, 1.0) } else { v.signum() };
            let (least, most) = (middle - 0.5 * span, middle + 0.5 * span);
            let found = mean_clamped(least, most, width);
            assert!((found - mean(sign, least, most)).abs() < 1e-3, "{middle} {span} {width}");
        }
        for (from, to) in [(-3.0, 2.0), (0.1, 0.2), (-40.0, 700.0)] {
            assert!((mean_tanh(from, to) - mean(f64::tanh, from, to)).abs() < 1e-3, "{from} {to}");
        }
    }
}
