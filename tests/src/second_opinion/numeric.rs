//! Derivatives, integrals and steps on a uniform grid.

/// Derivative by central differences, one-sided at the ends; per unit of `period`.
#[must_use]
pub fn gradient(values: &[f64], period: f64) -> Vec<f64> {
    let last = values.len() - 1;
    let slope = |i: usize| {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(last));
        (values[after] - values[before]) / ((after - before) as f64 * period)
    };
    (0..values.len()).map(slope).collect()
}

/// Integral from the first value on, of fourth order: the trapezoidal rule with the slopes at both ends (Euler, Maclaurin).
#[must_use]
pub fn integral(values: &[f64], slopes: &[f64], period: f64) -> Vec<f64> {
    let mut sum = 0.0;
    let so_far = |i: usize| {
        if i > 0 {
            sum += 0.5 * (values[i - 1] + values[i]) * period;
        }
        sum - period * period / 12.0 * (slopes[i] - slopes[0])
    };
    (0..values.len()).map(so_far).collect()
}

/// Takes the mean away.
pub fn centre(values: &mut [f64]) {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    values.iter_mut().for_each(|value| *value -= mean);
}

/// Largest magnitude.
#[must_use]
pub fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |peak, value| value.abs().max(peak))
}

/// Least and greatest value.
#[must_use]
pub fn range(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)))
}

/// The value that a share of all does not exceed.
#[must_use]
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted[(share * (sorted.len() - 1) as f64).round() as usize]
}

/// Root of the mean square.
#[must_use]
pub fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

/// The cubic step from 0 to 1 over `x` from 0 to 1.
#[must_use]
pub fn smooth_step(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
