//! Applies the planned filter at every row of a recording, for predictions beside the recorded rows: all at once, or stretch by stretch, so that
//! a long recording needs no more memory than a short one.

use std::ops::Range;

use super::super::Samples;
use super::super::grid::{Grid, Segment, interpolate_part};
use super::super::plan::Preparation;
use super::{empty, extend, target, temperature_filter, unfiltered};
use crate::error::Result;
use crate::numerics::filter::Part;
use crate::numerics::filter::gaussian::{GaussianFilter, Order};
use crate::recording::{Quantity, Recording};

/// Name of the channel that is smoothed twice.
const TEMPERATURE: &str = "temperature";

/// One sample for every row of the recording, at the row's own time: for predictions beside the recorded rows. The
/// actuator, recorded rigid body and named channels are filtered like the motion; near ends and gaps the motion is continued by point reflection.
///
/// # Errors
/// `FRK-D009` when the task lacks a column.
pub fn prepare_every_row(recording: &Recording, preparation: &Preparation) -> Result<Samples> {
    prepare_every_row_of(recording, preparation, &|_| true)
}

/// The same with those named channels only that are read: a large recording may have many.
///
/// # Errors
/// As [`prepare_every_row`].
pub(crate) fn prepare_every_row_of(
    recording: &Recording,
    preparation: &Preparation,
    is_read: &dyn Fn(&str) -> bool,
) -> Result<Samples> {
    Ok(EveryRow::of(recording, preparation, is_read)?.samples(&(0..recording.len())))
}

/// Samples at every row of a recording, as many of them at a time as are asked for.
pub(crate) struct EveryRow<'a> {
    recording: &'a Recording,
    preparation: &'a Preparation,
    is_read: &'a dyn Fn(&str) -> bool,
    /// Clock and filter; `None` where nothing is filtered.
    filtered: Option<Filtered<'a>>,
}

struct Filtered<'a> {
    time: &'a [f64],
    grid: Grid,
    filter: GaussianFilter,
    of_temperature: GaussianFilter,
}

impl<'a> EveryRow<'a> {
    /// # Errors
    /// As [`prepare_every_row`].
    pub(crate) fn of(
        recording: &'a Recording,
        preparation: &'a Preparation,
        is_read: &'a dyn Fn(&str) -> bool,
    ) -> Result<Self> {
        let filtered = match preparation.sigma_s {
            None => None,
            Some(sigma_s) => {
                let time = &recording.require(&[Quantity::Time], "a recording with a motion")?.values;
                let grid = Grid::of(recording, time);
                let filter = GaussianFilter::new(sigma_s, grid.period_s);
                Some(Filtered { time, filter, of_temperature: temperature_filter(1.0 / grid.period_s), grid })
            }
        };
        Ok(Self { recording, preparation, is_read, filtered })
    }

    /// Whether the motion is interrupted before a row.
    pub(crate) fn begins_segment(&self, row: usize) -> bool {
        let segments = self.filtered.as_ref().map_or(&[][..], |filtered| &filtered.grid.segments);
        segments.binary_search_by_key(&row, |segment| segment.rows.start).is_ok()
    }

    /// Samples at these rows, whose segments are the parts of those of the recording.
    pub(crate) fn samples(&self, rows: &Range<usize>) -> Samples {
        let recording = self.recording;
        let Some(filtered) = &self.filtered else { return unfiltered(recording, rows) };
        let mut samples = empty(recording, self.preparation, Some(1.0 / filtered.grid.period_s));
        for segment in &filtered.grid.segments {
            let part = segment.rows.start.max(rows.start)..segment.rows.end.min(rows.end);
            if part.is_empty() {
                continue;
            }
            let at_rows = |channel: &[f64], order| filtered.at_rows(segment, &part, channel, order);
            samples.time.extend(&filtered.time[part.clone()]);
            let actuator = |channel: &[f64]| at_rows(channel, Order::Smooth);
            let is_read = |name: &str| name != TEMPERATURE && (self.is_read)(name);
            extend(&mut samples, recording, self.preparation, &is_read, at_rows, actuator);
            if let Some(temperature) = recording.named(TEMPERATURE).filter(|_| (self.is_read)(TEMPERATURE)) {
                let smooth = filtered.smooth_temperature(segment, &part, &temperature.values);
                match samples.channels.iter_mut().find(|(name, _)| name == TEMPERATURE) {
                    Some((_, values)) => values.extend(smooth),
                    None => samples.channels.push((TEMPERATURE.to_owned(), smooth)),
                }
            }
            samples.segments.push(part.start - rows.start..part.end - rows.start);
        }
        samples.recorded = target(recording).map(|values| values[rows.clone()].to_vec());
        samples.recordings = vec![(recording.label.clone(), 0..rows.len())];
        samples
    }
}

impl Filtered<'_> {
    /// A channel at some rows of a segment.
    fn at_rows(&self, segment: &Segment, rows: &Range<usize>, channel: &[f64], order: Order) -> Vec<f64> {
        let points = self.grid.points_around(segment, self.time, rows);
        let needed = self.filter.needed(&points, segment.points);
        let values = self.grid.values_at(segment, &needed, self.time, channel);
        let filtered = self.filter.apply_within(&Part::of(&values, needed.start, segment.points), order, &points);
        if !self.grid.resampled {
            return filtered;
        }
        interpolate_part(&self.grid.times(segment, &points), &filtered, &self.time[rows.clone()])
    }

    /// A temperature at some rows of a segment: filtered as every channel, and smoothed once more.
    fn smooth_temperature(&self, segment: &Segment, rows: &Range<usize>, channel: &[f64]) -> Vec<f64> {
        let (begin, whole) = (segment.rows.start, segment.rows.len());
        let wanted = rows.start - begin..rows.end - begin;
        let needed = self.of_temperature.needed(&wanted, whole);
        let rows_needed = begin + needed.start..begin + needed.end;
        let values = self.at_rows(segment, &rows_needed, channel, Order::Smooth);
        self.of_temperature.apply_within(&Part::of(&values, needed.start, whole), Order::Smooth, &wanted)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::joint::Joint;
    use crate::recording::parse;
    use crate::samples::VelocitySource;

    /// A swing with a gap, of a clock that jitters or does not, with a temperature.
    fn swing(jitter_s: f64) -> Recording {
        let row = |i: usize| {
            let time =
                0.001 * i as f64 + if i.is_multiple_of(3) { jitter_s } else { 0.0 } + if i >= 4100 { 0.5 } else { 0.0 };
            let (position, torque) = ((1.2 * time).sin(), (7.0 * time).cos());
            format!("{time},{position},{torque},{}\n", 20.0 + 0.1 * time + (i % 5) as f64)
        };
        let rows: String = (0..9000).map(row).collect();
        let text = format!("time_s,position_rad,torque_Nm,temperature_C\n{rows}");
        parse("swing.csv", text.as_bytes(), &Joint::default()).unwrap()
    }

    #[test]
    fn stretches_hold_what_the_whole_does_bit_for_bit() {
        for (jitter_s, sigma_s) in [(0.0, 0.004), (3e-4, 0.004), (0.0, 0.2), (3e-4, 0.2)] {
            let recording = swing(jitter_s);
            let preparation = Preparation {
                sigma_s: Some(sigma_s),
                rate_hz: None,
                velocity: VelocitySource::Derived,
                acceleration_noise: 0.0,
                torque_delay_s: 0.0,
            };
            let whole = prepare_every_row(&recording, &preparation).unwrap();
            let rows = EveryRow::of(&recording, &preparation, &|_| true).unwrap();
            for part in [0..700, 700..701, 3000..6000, 8999..9000] {
                let stretch = rows.samples(&part);
                assert_eq!(stretch.time, whole.time[part.clone()]);
                for name in ["position", "velocity", "acceleration", "temperature"] {
                    assert_eq!(
                        stretch.input(name).unwrap(),
                        &whole.input(name).unwrap()[part.clone()],
                        "{name} {part:?}"
                    );
                }
                assert_eq!(stretch.recorded.unwrap(), whole.recorded.as_ref().unwrap()[part]);
            }
        }
    }
}
