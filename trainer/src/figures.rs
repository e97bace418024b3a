//! Figures as a person reads them: three digits, a fitting prefix, a unit.

/// Decimals at most; what needs more has a unit that does not suit it.
const MOST_DECIMALS: f64 = 9.0;

/// A value with its unit, three digits, in milli or micro where that reads better.
#[must_use]
pub fn quantity(value: f64, unit: &str) -> String {
    if unit == "1" || unit.is_empty() {
        return digits(value);
    }
    let (factor, prefix) = prefix(value, unit);
    format!("{} {prefix}{unit}", digits(value * factor))
}

/// Two values with a word between them and their unit, the prefix that suits the larger one.
pub(crate) fn pair(from: f64, word: &str, to: f64, unit: &str) -> String {
    if unit == "1" || unit.is_empty() {
        return format!("{} {word} {}", digits(from), digits(to));
    }
    let (factor, prefix) = prefix(from.abs().max(to.abs()), unit);
    format!("{} {word} {} {prefix}{unit}", digits(from * factor), digits(to * factor))
}

/// An estimate with its unit, with as many digits as the width of its interval needs.
pub(crate) fn estimate(value: f64, [low, high]: [f64; 2], unit: &str) -> String {
    let (factor, prefix) = prefix(value, unit);
    let unit = if unit == "1" { "" } else { unit };
    format!("{} {prefix}{unit}", to_width(value * factor, 0.5 * (high - low) * factor)).trim_end().to_string()
}

/// An interval with its unit, with as many digits as its width needs.
pub(crate) fn interval([low, high]: [f64; 2], unit: &str) -> String {
    let (factor, prefix) = prefix(low.abs().max(high.abs()), unit);
    let [from, to] = [low, high].map(|end| to_width(end * factor, 0.5 * (high - low) * factor));
    let unit = if unit == "1" { "" } else { unit };
    format!("{from} to {to} {prefix}{unit}").trim_end().to_string()
}

/// A value with the decimals at which half the width of its interval has two significant digits; three digits of the value where there is
/// no such width.
fn to_width(value: f64, half: f64) -> String {
    let decimals = 1.0 - half.log10().floor();
    if !(half > 0.0 && decimals <= MOST_DECIMALS) || value.abs() >= 1e6 {
        return digits(value);
    }
    let text = format!("{value:.*}", decimals.max(0.0) as usize);
    // What rounds to zero has no sign.
    if text.bytes().all(|byte| b"-0.".contains(&byte)) { text.replace('-', "") } else { text }
}

fn prefix(value: f64, unit: &str) -> (f64, &'static str) {
    let plain = matches!(unit, "rad" | "m" | "s" | "N" | "N m" | "A" | "rad/s" | "m/s");
    match value.abs() {
        size if !plain || size == 0.0 => (1.0, ""),
        size if size < 1e-4 => (1e6, "u"),
        size if size < 0.02 => (1e3, "m"),
        _ => (1.0, ""),
    }
}

/// Three significant digits; powers of ten only where plain digits would be long.
#[must_use]
pub fn digits(value: f64) -> String {
    let size = value.abs();
    if size == 0.0 || !value.is_finite() {
        return if value == 0.0 { "0".to_string() } else { format!("{value}") };
    }
    if !(1e-4..1e6).contains(&size) {
        return format!("{value:.2e}");
    }
    let decimals = (2 - size.log10().floor() as i32).clamp(0, 6) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn figures_have_three_digits_and_a_fitting_prefix() {
        let shown: Vec<String> =
            [0.0, 1.0, -12.345, 1234.5, 2.5e-5].into_iter().map(|value| quantity(value, "rad")).collect();
        assert_eq!(shown, ["0 rad", "1 rad", "-12.3 rad", "1234 rad", "25 urad"]);
        assert_eq!(quantity(0.0021, "N m s/rad"), "0.0021 N m s/rad");
        assert_eq!(pair(0.0014, "to", 0.0032, "rad"), "1.4 to 3.2 mrad");
        assert_eq!(pair(1.41, "to", 3.19, "1"), "1.41 to 3.19");
    }

    #[test]
    fn an_interval_has_the_digits_that_its_width_needs() {
        assert_eq!(interval([1.4965, 1.5035], "N m"), "1.4965 to 1.5035 N m");
        assert_eq!(interval([1.2, 3.4], "1"), "1.2 to 3.4");
        assert_eq!(interval([-0.0004, 0.0032], "kg"), "-0.0004 to 0.0032 kg");
        assert_eq!(interval([0.001_612, 0.001_644], "rad"), "1.612 to 1.644 mrad");
        assert_eq!(interval([890.0, 1320.0], "N"), "890 to 1320 N");
        assert_eq!(interval([-0.001, 40.0], "N"), "0 to 40 N");
        assert_eq!(interval([2.0, 2.0], "N"), "2 to 2 N");
        assert_eq!(interval([2.0, f64::INFINITY], "N"), "2 to inf N");
        assert_eq!(estimate(0.897_96, [0.8951, 0.9007], "N m s/rad"), "0.8980 N m s/rad");
        assert_eq!(estimate(3.0, [3.0, 3.0], "1"), "3");
    }
}
