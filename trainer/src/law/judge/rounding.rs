//! Constants rounded to the digits that the data support: the law that is printed is the law that is exported and scored.

use super::uncertainty::Uncertainty;
use crate::law::fitting::problem::{Fit, Problem};
use crate::law::fitting::projection::dot;

/// What rounding may add to the sum of squares, in variances of the noise; a 95 % interval spans 3.84.
const RSS_RISE_VARIANCES: f64 = 0.1;
/// A constant is rounded to this share of its standard error at most.
const STANDARD_ERROR_SHARE: f64 = 0.1;
/// Significant digits that every constant keeps, and that a constant without a standard error is rounded to.
const LEAST_DIGITS: i32 = 2;
const FIXED_DIGITS: i32 = 4;
/// Digits after which rounding is given up.
const MOST_DIGITS: i32 = 17;

/// The fit with the fewest digits that leave the sum of squares as it is for all that the data can tell.
pub(in crate::law) fn rounded(problem: &Problem<'_>, fit: &Fit, uncertainty: &Uncertainty) -> Fit {
    let allowed = fit.rss + RSS_RISE_VARIANCES * uncertainty.noise.powi(2) * uncertainty.correlation_length;
    let decimals: Vec<i32> =
        fit.params.iter().zip(&uncertainty.standard_errors).map(|(x, se)| supported(*x, *se)).collect();
    for more in 0..MOST_DIGITS {
        let params = fit.params.iter().zip(&decimals).map(|(x, d)| to_decimals(*x, d + more)).collect();
        let mut trial = Fit { params, ..fit.clone() };
        let residuals = problem.residuals(&trial);
        trial.rss = dot(&residuals, &residuals);
        if trial.rss <= allowed {
            return trial;
        }
    }
    fit.clone()
}

/// Decimals, negative for tens, that a value with this standard error is worth.
fn supported(value: f64, standard_error: f64) -> i32 {
    let leading = exponent(value);
    if standard_error > 0.0 && standard_error.is_finite() {
        (-exponent(STANDARD_ERROR_SHARE * standard_error)).max(LEAST_DIGITS - 1 - leading)
    } else {
        FIXED_DIGITS - 1 - leading
    }
}

/// Power of ten of the leading digit; 0 of zero.
fn exponent(x: f64) -> i32 {
    if x == 0.0 { 0 } else { libm::floor(libm::log10(x.abs())) as i32 }
}

/// Rounded in decimal, so that it reads back as it is printed.
fn to_decimals(x: f64, decimals: i32) -> f64 {
    let digits = decimals + exponent(x);
    let text = match usize::try_from(digits) {
        Ok(digits) if digits <= MOST_DIGITS as usize => format!("{x:.digits$e}"),
        _ => return x,
    };
    text.parse().unwrap_or(x)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_follow_the_standard_error() {
        for (value, error, printed) in [
            (22.003_456, 0.01, 22.003),
            (0.100_26, 0.002, 0.1003),
            (51.37, 40.0, 51.0),
            (0.030_4, 1.0, 0.03),
            (123_456.0, f64::INFINITY, 123_500.0),
            (-7.777_7, 0.5, -7.78),
        ] {
            assert_eq!(to_decimals(value, supported(value, error)), printed, "{value} ± {error}");
        }
    }
}
