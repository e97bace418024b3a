//! A uniform time grid under time stamps that jitter or have gaps.

use std::borrow::Cow;
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
    pub(super) fn values<'a>(&self, segment: &Segment, time: &[f64], channel: &'a [f64]) -> Cow<'a, [f64]> {
        self.values_at(segment, &(0..segment.points), time, channel)
    }

    /// The same at some of its points.
    pub(super) fn values_at<'a>(
        &self,
        segment: &Segment,
        points: &Range<usize>,
        time: &[f64],
        channel: &'a [f64],
    ) -> Cow<'a, [f64]> {
        let (time, channel) = (&time[segment.rows.clone()], &channel[segment.rows.clone()]);
        if !self.resampled {
            return Cow::Borrowed(&channel[points.clone()]);
        }
        Cow::Owned(interpolate_part(time, channel, &self.times(segment, points)))
    }

    /// Times of some points of `segment`, s.
    pub(super) fn times(&self, segment: &Segment, points: &Range<usize>) -> Vec<f64> {
        points.clone().map(|point| segment.start_s + point as f64 * self.period_s).collect()
    }

    /// The points of `segment` between which these of its rows lie.
    pub(super) fn points_around(&self, segment: &Segment, time: &[f64], rows: &Range<usize>) -> Range<usize> {
        let begin = segment.rows.start;
        if !self.resampled {
            return rows.start - begin..rows.end - begin;
        }
        let place = |row: usize| ((time[row] - segment.start_s) / self.period_s).max(0.0) as usize;
        // A point more at each end, since the place of a row at a point may be rounded to either side.
        let last = (place(rows.end - 1) + 3).min(segment.points);
        place(rows.start).saturating_sub(1).min(last - 1)..last
    }
}

/// As [`interpolate`], of the values around `at` alone.
pub(super) fn interpolate_part(time: &[f64], values: &[f64], at: &[f64]) -> Vec<f64> {
    let (Some(from), Some(to)) = (at.first(), at.last()) else { return Vec::new() };
    let begin = time.partition_point(|time| time <= from).saturating_sub(1).min(time.len().saturating_sub(2));
    let end = (time.partition_point(|time| time <= to) + 1).min(time.len());
    interpolate(&time[begin..end], &values[begin..end], at)
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
    fn a_part_is_interpolated_as_the_whole() {
        let time: Vec<f64> = (0..300).map(|i| f64::from(i) + 0.3 * f64::from(i % 7)).collect();
        let values: Vec<f64> = time.iter().map(|t| (0.1 * t).sin()).collect();
        let at: Vec<f64> = (0..320).map(|i| 0.97 * f64::from(i) - 1.0).collect();
        let whole = interpolate(&time, &values, &at);
        for part in [0..1, 0..40, 17..180, 290..320, 319..320] {
            assert_eq!(interpolate_part(&time, &values, &at[part.clone()]), whole[part]);
        }
    }

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
