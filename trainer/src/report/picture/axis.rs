//! Scales and ticks.

use crate::figures::digits;

/// A linear scale from data to pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::report) struct Scale {
    low: f64,
    high: f64,
    begin: f64,
    end: f64,
}

impl Scale {
    /// A scale over finite `values` with a small margin; one unit wide where they do not vary.
    pub(in crate::report) fn over(values: impl Iterator<Item = f64>) -> (f64, f64) {
        let (low, high) = values
            .filter(|v| v.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), v| (low.min(v), high.max(v)));
        match (low.is_finite() && high.is_finite(), high > low) {
            (true, true) => (low - 0.03 * (high - low), high + 0.03 * (high - low)),
            (true, false) => (low - 0.5 * low.abs().max(1.0), low + 0.5 * low.abs().max(1.0)),
            _ => (0.0, 1.0),
        }
    }

    pub(super) fn new((low, high): (f64, f64), begin: f64, end: f64) -> Self {
        Self { low, high, begin, end }
    }

    /// Pixel of a value; beyond the ends it is held.
    pub(super) fn at(&self, value: f64) -> f64 {
        let share = ((value - self.low) / (self.high - self.low)).clamp(0.0, 1.0);
        self.begin + share * (self.end - self.begin)
    }

    /// Values of about `count` ticks at steps of 1, 2 or 5 times a power of ten, with their labels.
    pub(super) fn ticks(&self, count: usize) -> Vec<(f64, String)> {
        let rough = (self.high - self.low) / count.max(1) as f64;
        let power = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * power).find(|s| *s >= rough).unwrap_or(rough);
        let first = (self.low / step).ceil() as i64;
        let last = (self.high / step).floor() as i64;
        (first..=last)
            .map(|k| k as f64 * step)
            .map(|value| (value, if value.abs() < 1e-9 * step { "0".to_string() } else { digits(value) }))
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let labels: Vec<String> =
            Scale::new((-1.03, 1.03), 0.0, 100.0).ticks(5).into_iter().map(|(_, label)| label).collect();
        assert_eq!(labels, ["-1", "-0.5", "0", "0.5", "1"]);
    }

    #[test]
    fn a_range_without_width_still_has_a_scale() {
        let (low, high) = Scale::over([2.0, 2.0, f64::NAN].into_iter());
        assert!(low < 2.0 && high > 2.0);
        assert_eq!(Scale::over(std::iter::empty()), (0.0, 1.0));
    }
}
