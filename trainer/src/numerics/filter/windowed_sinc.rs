//! A Hamming-windowed sinc low-pass: the filter of `diagnose`, which every channel and every regressor passes.

use std::f64::consts::PI;
use std::ops::Range;

use super::continued;

/// A symmetric low-pass FIR filter (Hamming-windowed sinc), zero phase.
#[derive(Clone, Debug)]
pub struct ZeroPhase {
    taps: Vec<f64>,
    /// Cut-off frequency in Hz (half amplitude).
    pub cut_off_hz: f64,
}

/// Partial sums of the filter.
const LANES: usize = 4;

impl ZeroPhase {
    /// A filter with the given half-amplitude frequency for samples of `period` s. The transition ends at about
    /// one and a half times the cut-off.
    pub fn new(cut_off_hz: f64, period: f64) -> Self {
        let half = ((1.65 / (cut_off_hz * period)).round() as usize).max(1);
        let mut taps: Vec<f64> = (0..=2 * half)
            .map(|i| {
                let x = i as f64 - half as f64;
                let angle = 2.0 * PI * cut_off_hz * period * x;
                let sinc = if x == 0.0 { 1.0 } else { angle.sin() / angle };
                sinc * (0.54 + 0.46 * (PI * x / (half as f64 + 1.0)).cos())
            })
            .collect();
        let sum: f64 = taps.iter().sum();
        taps.iter_mut().for_each(|tap| *tap /= sum);
        Self { taps, cut_off_hz }
    }

    /// Half the length of the filter in samples: what is lost at each end of a segment.
    pub fn reach(&self) -> usize {
        self.taps.len() / 2
    }

    /// Filtered value at sample `i`; the caller keeps `i` at least [`Self::reach`] from the ends.
    pub fn at(&self, series: &[f64], i: usize) -> f64 {
        let half = self.reach();
        let window = &series[i - half..=i + half];
        // The filter is symmetric: add the mirrored samples first. Four sums, so that it vectorises and always rounds alike.
        let mut sums = [0.0; LANES];
        let (taps, before) = (self.taps[..half].chunks_exact(LANES), window[..half].chunks_exact(LANES));
        let after = window[half + 1..].rchunks_exact(LANES);
        let rest = half - half % LANES;
        for ((taps, before), after) in taps.zip(before).zip(after) {
            for lane in 0..LANES {
                sums[lane] += taps[lane] * (before[lane] + after[LANES - 1 - lane]);
            }
        }
        let tail: f64 = (rest..half).map(|j| self.taps[j] * (window[j] + window[2 * half - j])).sum();
        self.taps[half] * window[half] + (sums[0] + sums[1]) + (sums[2] + sums[3]) + tail
    }

    /// Filters a whole series, segment by segment; the ends are mirrored about their last sample (odd), so that a
    /// straight line stays straight.
    pub fn over(&self, series: &[f64], segments: &[Range<usize>]) -> Vec<f64> {
        let half = self.reach();
        let mut filtered = series.to_vec();
        for segment in segments {
            let piece = &series[segment.clone()];
            let padded = continued(piece, half);
            for i in 0..piece.len() {
                filtered[segment.start + i] = self.at(&padded, i + half);
            }
        }
        filtered
    }

    /// Root of the summed squares of the taps: what the filter leaves of white noise.
    pub fn gain(&self) -> f64 {
        self.taps.iter().map(|tap| tap * tap).sum::<f64>().sqrt()
    }

    /// Root of the summed squares of the taps of `D2 F` in 1/s2: what a second derivative makes of white position noise.
    pub fn second_derivative_gain(&self, period: f64) -> f64 {
        let tap = |i: isize| usize::try_from(i).ok().and_then(|i| self.taps.get(i)).copied().unwrap_or(0.0);
        let sum: f64 = (-1..=self.taps.len() as isize).map(|i| (tap(i - 1) - 2.0 * tap(i) + tap(i + 1)).powi(2)).sum();
        sum.sqrt() / (period * period)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn filter_keeps_lines_and_removes_high_frequencies() {
        let filter = ZeroPhase::new(50.0, 1e-3);
        let segments = vec![0..600];
        let line: Vec<f64> = (0..600).map(|i| 3.0 + 0.1 * f64::from(i)).collect();
        for (before, after) in line.iter().zip(filter.over(&line, &segments)) {
            assert!((before - after).abs() < 1e-9);
        }
        let fast: Vec<f64> = (0..600).map(|i| (2.0 * PI * 150.0 * 1e-3 * f64::from(i)).sin()).collect();
        assert!(filter.over(&fast, &segments)[100..500].iter().all(|v| v.abs() < 5e-3));
    }
}
