//! Figures as a person reads them: three digits, a fitting prefix, a unit.

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
}
