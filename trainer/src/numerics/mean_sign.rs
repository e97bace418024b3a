//! Means of smoothed signs over the velocities that a joint passes.

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
