//! A uniform time grid under time stamps that jitter or have gaps.

use std::ops::Range;

use crate::recording::Recording;

/// Name of the channel that numbers the trajectories of a campaign; a change of it interrupts the motion.
const TRAJECTORY: &str = "trajectory";

/// Steps that deviate by less than this share of the period count as uniform: the text's rounding, not jitter.
const UNIFORM_JITTER: f64 = 0.02;

/// The uniform grid of one recording.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Grid {
    pub(super) period_s: f64,
    /// Times of the grid, segment after segment.
    pub(super) segments: Vec<Segment>,
    /// Whether values have to be interpolated.
    pub(super) resampled: bool,
}

/// An uninterrupted stretch of the recording.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Segment {
    /// Rows of the recording.
    pub(super) rows: Range<usize>,
    /// Time of the first row, s.
    pub(super) start_s: f64,
    /// Number of grid points.
    pub(super) points: usize,
}

/// Whether the time stamps of a recording scatter by more than the rounding of their text.
fn is_resampled(recording: &Recording) -> bool {
    recording.health.jitter > UNIFORM_JITTER
}

/// What is said of the clock behind what is said of the filter.
pub(crate) fn told_of_clock<'a>(recordings: impl IntoIterator<Item = &'a Recording>) -> &'static str {
    if recordings.into_iter().any(is_resampled) {
        "; uneven time stamps linearly interpolated to a uniform grid"
    } else {
        ""
    }
}

impl Grid {
    /// The grid of the mean period; a gap of the clock and a new `trajectory` begin a new segment.
    pub(super) fn of(recording: &Recording, time: &[f64]) -> Self {
        Self::at(recording, time, None)
    }

    /// The grid of a period (s) where the clock jitters and values are interpolated anyway, else of the mean one.
    pub(super) fn at(recording: &Recording, time: &[f64], jittering_s: Option<f64>) -> Self {
        let health = &recording.health;
        let resampled = is_resampled(recording);
        let mut bounds: Vec<usize> = std::iter::once(0).chain(health.gaps.iter().copied()).collect();
        if let Some(trajectory) = recording.named(TRAJECTORY) {
            let changes =
                trajectory.values.windows(2).enumerate().filter(|(_, pair)| pair[0].round() != pair[1].round());
            bounds.extend(changes.map(|(before, _)| before + 1));
        }
        bounds.push(time.len());
        bounds.sort_unstable();
        bounds.dedup();
        // The median of rounded time stamps is itself rounded; the mean over the uninterrupted stretches is not.
        let (mut span, mut steps) = (0.0, 0usize);
        for pair in bounds.windows(2) {
            span += time[pair[1] - 1] - time[pair[0]];
            steps += pair[1] - pair[0] - 1;
        }
        let mean_s = if steps > 0 { span / steps as f64 } else { 1.0 };
        let period_s = jittering_s.filter(|_| resampled).unwrap_or(mean_s);
        let segments = bounds
            .windows(2)
            .map(|pair| {
                let rows = pair[0]..pair[1];
                let points = if resampled {
                    ((time[pair[1] - 1] - time[pair[0]]) / period_s + 1e-6).floor() as usize + 1
                } else {
                    rows.len()
                };
                Segment { start_s: time[pair[0]], rows, points }
            })
            .collect();
        Self { period_s, segments, resampled }
    }

    /// Values of one channel on the grid of `segment`, linearly interpolated between rows where the clock jitters.
    pub(super) fn values(&self, segment: &Segment, time: &[f64], channel: &[f64]) -> Vec<f64> {
        let (time, channel) = (&time[segment.rows.clone()], &channel[segment.rows.clone()]);
        if !self.resampled {
            return channel.to_vec();
        }
        let grid: Vec<f64> = (0..segment.points).map(|i| segment.start_s + i as f64 * self.period_s).collect();
        interpolate(time, channel, &grid)
    }
}

/// Linear interpolation of `values` at increasing `time` onto increasing `at`; beyond the ends the last value holds.
pub(crate) fn interpolate(time: &[f64], values: &[f64], at: &[f64]) -> Vec<f64> {
    let last = time.len() - 1;
    let mut left = 0;
    at.iter()
        .map(|&t| {
            while left + 1 < last && time[left + 1] <= t {
                left += 1;
            }
            let right = (left + 1).min(last);
            let span = time[right] - time[left];
            let share = if span > 0.0 { ((t - time[left]) / span).clamp(0.0, 1.0) } else { 0.0 };
            values[left] + share * (values[right] - values[left])
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn interpolation_is_exact_on_a_line_and_holds_beyond_the_ends() {
        let time = [0.0, 0.9, 2.1, 3.0];
        let line: Vec<f64> = time.iter().map(|t| 1.0 + 2.0 * t).collect();
        let out = interpolate(&time, &line, &[-1.0, 0.0, 1.0, 2.5, 3.0, 9.0]);
        for (found, wanted) in out.iter().zip([1.0, 1.0, 3.0, 6.0, 7.0, 7.0]) {
            assert!((found - wanted).abs() < 1e-12, "{out:?}");
        }
    }
}
