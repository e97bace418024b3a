//! A Gaussian low-pass and its first two derivatives: the filter of `fit` and `predict`.
//!
//! Velocity is the convolution of the position with the derivative of the kernel and acceleration that with its second
//! derivative, so that F, F D and F D2 have the same gain at every frequency and terms that are linear in the motion
//! match the filtered torque exactly (rule P1).

use super::Part;
use crate::numerics::products::dot;
use std::ops::Range;

/// The kernel is cut off at this many standard deviations.
const HALF_WIDTH_SIGMAS: f64 = 4.0;

/// A wide Gaussian leaves nothing between points this close that a straight line would miss: 1/8 of the square of their
/// distance in standard deviations, 1e-4 of what is left of the noise.
const NODES_IN_SIGMA: f64 = 32.0;

/// Frequency at which a Gaussian of standard deviation s passes half the power is this over s: sqrt(ln 2) / 2 pi.
const HALF_POWER: f64 = 0.132_505_182;

/// A sampled Gaussian low-pass and its first two derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct GaussianFilter {
    /// Standard deviation of the kernel, s.
    pub sigma_s: f64,
    /// Sample period, s.
    pub period_s: f64,
    smooth: Vec<f64>,
    first: Vec<f64>,
    second: Vec<f64>,
}

/// Which kernel to convolve with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// The low-pass itself.
    Smooth,
    /// Low-pass and first derivative.
    First,
    /// Low-pass and second derivative.
    Second,
}

impl GaussianFilter {
    /// A filter of standard deviation `sigma_s` for signals sampled every `period_s` (both in s, above zero). Below one
    /// period the kernel would no longer be a sampled Gaussian; one period is then taken.
    #[must_use]
    pub fn new(sigma_s: f64, period_s: f64) -> Self {
        let sigma_s = sigma_s.max(period_s);
        let sigma = sigma_s / period_s;
        let half = (HALF_WIDTH_SIGMAS * sigma).ceil() as i64;
        let offsets = || (-half..=half).map(|k| k as f64);
        let gauss: Vec<f64> = offsets().map(|k| (-0.5 * (k / sigma).powi(2)).exp()).collect();
        // The moments are made exact, so that constants, ramps and parabolas pass without error.
        let total: f64 = gauss.iter().sum();
        let smooth: Vec<f64> = gauss.iter().map(|g| g / total).collect();
        let slope: f64 = offsets().zip(&smooth).map(|(k, g)| k * k * g).sum();
        let first = offsets().zip(&smooth).map(|(k, g)| k * g / (slope * period_s)).collect();
        let centred: Vec<f64> = offsets().zip(&smooth).map(|(k, g)| (k * k - slope) * g).collect();
        let curvature: f64 = offsets().zip(&centred).map(|(k, c)| 0.5 * k * k * c).sum();
        let second = centred.iter().map(|c| c / (curvature * period_s * period_s)).collect();
        Self { sigma_s, period_s, smooth, first, second }
    }

    /// The same filter with a low-pass that puts a signal, recorded late by `delay_s` (negative where early, shorter than the half width), back to
    /// its time.
    #[must_use]
    pub fn advanced_by(&self, delay_s: f64) -> Self {
        let (sigma, shift) = (self.sigma_s / self.period_s, delay_s / self.period_s);
        let half = self.half_width() as i64;
        let gauss: Vec<f64> = (-half..=half).map(|k| (-0.5 * ((k as f64 - shift) / sigma).powi(2)).exp()).collect();
        let total: f64 = gauss.iter().sum();
        Self { smooth: gauss.iter().map(|g| g / total).collect(), ..self.clone() }
    }

    /// Samples lost at each end of a segment.
    #[must_use]
    pub fn half_width(&self) -> usize {
        self.smooth.len() / 2
    }

    /// Frequency at which the power is halved, Hz.
    #[must_use]
    pub fn cutoff_hz(&self) -> f64 {
        HALF_POWER / self.sigma_s
    }

    /// Standard deviation of the output for white noise of unit standard deviation at the input.
    #[must_use]
    pub fn noise_gain(&self, order: Order) -> f64 {
        self.kernel(order).iter().map(|weight| weight * weight).sum::<f64>().sqrt()
    }

    /// Convolution at every `stride`-th sample whose window lies inside the signal, from index
    /// [`half_width`](Self::half_width) on. A signal shorter than the window gives nothing.
    #[must_use]
    pub fn apply(&self, signal: &[f64], order: Order, stride: usize) -> Vec<f64> {
        let kernel = self.kernel(order);
        // A correlation: the kernel of the first derivative is odd and already has the sign for it.
        signal.windows(kernel.len()).step_by(stride.max(1)).map(|window| dot(window, kernel)).collect()
    }

    /// Convolution at every sample: beyond its ends the signal is continued by point reflection, which keeps level and
    /// slope. Values within a half width of an end are less certain.
    #[must_use]
    pub fn apply_everywhere(&self, signal: &[f64], order: Order) -> Vec<f64> {
        self.apply_within(&Part::all(signal), order, &(0..signal.len()))
    }

    /// The same at the `wanted` samples, of which the part holds what [`needed`](Self::needed) says.
    pub(crate) fn apply_within(&self, part: &Part, order: Order, wanted: &Range<usize>) -> Vec<f64> {
        let (half, stride) = (self.half_width(), self.node_stride());
        if stride < 2 {
            return self.apply(&part.continued(wanted, half), order, 1);
        }
        let between_nodes = self.between_nodes(wanted, part.whole());
        let nodes = self.apply(&part.continued(&between_nodes, half), order, stride);
        let between = |row: usize| {
            let (node, beyond) = (row / stride, row % stride);
            let next = nodes.get(node + 1).unwrap_or(&nodes[node]);
            nodes[node] + (next - nodes[node]) * beyond as f64 / stride as f64
        };
        (wanted.start - between_nodes.start..wanted.end - between_nodes.start).map(between).collect()
    }

    /// The samples that the filter needs for the `wanted` ones, of a signal of length `whole`.
    pub(crate) fn needed(&self, wanted: &Range<usize>, whole: usize) -> Range<usize> {
        let (half, between_nodes) = (self.half_width(), self.between_nodes(wanted, whole));
        between_nodes.start.saturating_sub(half)..(between_nodes.end + half).min(whole)
    }

    /// The samples from the node before the `wanted` ones to that behind them.
    fn between_nodes(&self, wanted: &Range<usize>, whole: usize) -> Range<usize> {
        let stride = self.node_stride().max(1);
        wanted.start / stride * stride..(wanted.end.div_ceil(stride) * stride + 1).min(whole)
    }

    /// Samples from one node of a wide filter to the next.
    fn node_stride(&self) -> usize {
        (self.sigma_s / self.period_s / NODES_IN_SIGMA) as usize
    }

    fn kernel(&self, order: Order) -> &[f64] {
        match order {
            Order::Smooth => &self.smooth,
            Order::First => &self.first,
            Order::Second => &self.second,
        }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn parabolas_pass_with_exact_derivatives(
            sigma in 1.0..40.0_f64, a in -3.0..3.0_f64, b in -3.0..3.0_f64, c in -3.0..3.0_f64,
        ) {
            let period = 0.004;
            let filter = GaussianFilter::new(sigma * period, period);
            let time: Vec<f64> = (0..2 * filter.half_width() + 7).map(|i| i as f64 * period).collect();
            let signal: Vec<f64> = time.iter().map(|t| a + b * t + c * t * t).collect();
            let first = filter.apply(&signal, Order::First, 1);
            let second = filter.apply(&signal, Order::Second, 1);
            for (i, (v, w)) in first.iter().zip(&second).enumerate() {
                let t = time[i + filter.half_width()];
                prop_assert!((v - (b + 2.0 * c * t)).abs() < 1e-8);
                prop_assert!((w - 2.0 * c).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn smooth_first_and_second_have_one_gain() {
        let period = 0.001;
        let filter = GaussianFilter::new(0.005, period);
        for frequency in [1.0, 10.0, 30.0] {
            let w = 2.0 * PI * frequency;
            let wave: Vec<f64> = (0..1000).map(|i| (w * i as f64 * period).sin()).collect();
            let peak = |order| filter.apply(&wave, order, 1).iter().fold(0.0_f64, |m, x| m.max(x.abs()));
            let gain = peak(Order::Smooth);
            assert!((gain - (-0.5 * (w * 0.005).powi(2)).exp()).abs() < 1e-3);
            assert!((peak(Order::First) / w / gain - 1.0).abs() < 5e-3, "{frequency}");
            assert!((peak(Order::Second) / (w * w) / gain - 1.0).abs() < 5e-3, "{frequency}");
        }
    }

    #[test]
    fn half_power_is_at_the_stated_frequency() {
        let filter = GaussianFilter::new(0.01, 0.001);
        let w = 2.0 * PI * filter.cutoff_hz();
        assert!(((-(w * 0.01).powi(2)).exp() - 0.5).abs() < 1e-6);
    }

    #[test]
    fn continued_ends_keep_a_ramp() {
        let filter = GaussianFilter::new(0.01, 0.001);
        let ramp: Vec<f64> = (0..200).map(|i| 3.0 * f64::from(i) * 0.001).collect();
        assert!(filter.apply_everywhere(&ramp, Order::First).iter().all(|v| (v - 3.0).abs() < 1e-9));
        assert_eq!(filter.apply_everywhere(&ramp, Order::Smooth).len(), ramp.len());
    }
}
