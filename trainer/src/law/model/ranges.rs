//! What values the data let the non-linear constants take, and where to start looking for them.

use super::data::{ChannelRole, LawData, LawError};
use super::structure::{Layout, Nonlinear, SignForm};

/// Samples that must lie inside the smoothed sign for its width to be seen.
const SAMPLES_IN_TRANSITION: usize = 5;

/// Speeds below this share of the fastest are rest.
const REST_SPEED_RATIO: f64 = 1e-3;

/// Most starting orders of a ripple that are tried.
const MOST_ORDERS: usize = 400;

/// Range, scale and starts of one non-linear constant.
#[derive(Clone, Debug, PartialEq)]
pub struct Range {
    /// Smallest admissible value.
    pub lower: f64,
    /// Largest admissible value.
    pub upper: f64,
    /// Whether steps are taken in the logarithm (positive constants without a natural zero).
    pub logarithmic: bool,
    /// Starting values, ascending.
    pub starts: Vec<f64>,
}

impl Range {
    /// Whether a value has run to the end of the range, where the form is no longer itself.
    pub fn is_end(&self, value: f64) -> bool {
        let near = 1e-3 * if self.logarithmic { value.abs() } else { self.upper - self.lower };
        value <= self.lower + near || value >= self.upper - near
    }

    fn logarithmic(lower: f64, upper: f64, starts: usize) -> Self {
        let upper = upper.max(lower * 2.0);
        let ratio = upper / lower;
        // Starts stay off the very ends, where every form degenerates into another one.
        let at = |i: usize| lower * libm::pow(ratio, (i as f64 + 0.5) / starts as f64);
        Self { lower, upper, logarithmic: true, starts: (0..starts).map(at).collect() }
    }

    fn listed(lower: f64, upper: f64, starts: &[f64]) -> Self {
        Self { lower, upper, logarithmic: true, starts: starts.to_vec() }
    }
}

/// Extents of the channels that the ranges follow from.
#[derive(Clone, Debug)]
pub struct Extents {
    fastest: f64,
    slowest: f64,
    slow: f64,
    spans: Vec<f64>,
    layout: Layout,
}

impl Extents {
    /// Reads them off the data.
    ///
    /// # Errors
    /// Those of [`LawData::check`].
    pub fn new(data: &LawData) -> Result<Self, LawError> {
        data.check()?;
        let velocity = data.velocity()?;
        let mut speeds: Vec<f64> = data.columns()[velocity].iter().map(|v| v.abs()).filter(|v| *v > 0.0).collect();
        speeds.sort_by(f64::total_cmp);
        let fastest = speeds[speeds.len() - 1];
        let slow = speeds[SAMPLES_IN_TRANSITION.min(speeds.len() - 1)].max(REST_SPEED_RATIO * fastest);
        let slowest = speeds[0].max(0.1 * REST_SPEED_RATIO * fastest);
        let mut references = Vec::new();
        let mut spans = Vec::new();
        for channel in &data.channels {
            let low = channel.values.iter().copied().fold(f64::INFINITY, f64::min);
            let high = channel.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            spans.push(high - low);
            references.push(match channel.role {
                ChannelRole::Temperature => round_inside(low, high),
                _ => 0.0,
            });
        }
        Ok(Self { fastest, slowest, slow, spans, layout: Layout { velocity, references } })
    }

    /// Where the channels are.
    pub fn layout(&self) -> &Layout {
        &self.layout
    }

    /// The largest speed.
    pub fn fastest(&self) -> f64 {
        self.fastest
    }

    /// Whether a channel varies at all.
    pub fn varies(&self, channel: usize) -> bool {
        self.spans[channel] > 0.0
    }

    /// The steepest sign that the data can tell from a step: a slope (tanh, atan) or a width.
    pub fn steepest(&self, sign: SignForm) -> f64 {
        match sign {
            SignForm::Tanh => 3.0 / self.slow,
            SignForm::Arctan => 30.0 / self.slow,
            SignForm::Algebraic => 0.1 * self.slow,
            SignForm::Parabolic | SignForm::Cubic => self.slow,
        }
    }

    /// The range of one constant of a law with this smoothing.
    pub fn range(&self, constant: Nonlinear, sign: SignForm) -> Range {
        let (fast, slow) = (self.fastest, self.slow);
        match constant {
            Nonlinear::Smoothing => match sign {
                SignForm::Tanh => Range::logarithmic(1.0 / fast, (20.0 / self.slowest).max(4.0 / fast), 8),
                SignForm::Arctan => Range::logarithmic(0.5 / fast, (1e3 / self.slowest).max(4.0 / fast), 9),
                SignForm::Algebraic => Range::logarithmic(1e-3 * self.slowest, fast, 8),
                SignForm::Parabolic | SignForm::Cubic => Range::logarithmic(0.5 * self.slowest, fast, 12),
            },
            Nonlinear::StribeckVelocity => Range::logarithmic((2.0 * slow).min(0.02 * fast), 1.5 * fast, 7),
            Nonlinear::BreakawayVelocity => Range::logarithmic(slow, 0.5 * fast, 7),
            Nonlinear::StribeckExponent => Range::listed(0.3, 4.0, &[0.5, 1.0, 2.0]),
            Nonlinear::Exponent => Range::listed(0.1, 4.0, &[0.4, 0.7, 1.5, 2.5]),
            Nonlinear::RootExponent => Range::listed(0.1, 0.7, &[0.25, 0.5]),
            Nonlinear::Rate(i) => {
                let span = self.spans[i];
                let starts = [-2.0, -0.5, 0.3, 1.0, 3.0].map(|x| x / span);
                Range { lower: -10.0 / span, upper: 10.0 / span, logarithmic: false, starts: starts.to_vec() }
            }
            Nonlinear::Order(i) => {
                let step = std::f64::consts::PI / (1.5 * self.spans[i]);
                let starts: Vec<f64> = (2..MOST_ORDERS).map(|n| step * n as f64).collect();
                Range { lower: step, upper: step * MOST_ORDERS as f64, logarithmic: false, starts }
            }
        }
    }
}

/// The roundest number (of steps 100, 50, 20, 10, 5 ...) near the middle of an interval.
fn round_inside(low: f64, high: f64) -> f64 {
    let middle = 0.5 * (low + high);
    let span = (high - low).max(1e-9);
    let decade = libm::pow(10.0, libm::ceil(libm::log10(span)));
    for step in [1.0, 0.5, 0.2, 0.1, 0.05].map(|f| f * decade) {
        let round = libm::round(middle / step) * step;
        if (low..=high).contains(&round) {
            return round;
        }
    }
    middle
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn references_are_round_and_inside() {
        assert_eq!(round_inside(18.3, 42.0), 0.0_f64.max(20.0).max(round_inside(18.3, 42.0)));
        for (low, high) in [(18.3, 42.0), (21.0, 23.5), (-3.0, 4.0), (20.0, 60.0)] {
            let r = round_inside(low, high);
            assert!((low..=high).contains(&r), "{low} {high} {r}");
        }
    }

    #[test]
    fn starts_lie_inside_the_bounds_and_ascend() {
        let r = Range::logarithmic(0.1, 50.0, 8);
        assert_eq!(r.starts.len(), 8);
        assert!(r.starts.windows(2).all(|w| w[0] < w[1]));
        assert!(r.starts.iter().all(|s| (r.lower..=r.upper).contains(s)));
    }
}
