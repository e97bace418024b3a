//! A recording on an even clock, before any filter: what a diagnosis filters itself.

use std::ops::Range;

use super::grid::Grid;
use crate::error::{Error, Result, codes};
use crate::recording::{Quantity, Recording};

/// Channels of a recording on an even clock.
#[derive(Clone, Debug)]
pub struct EvenClock {
    /// Sample period, s.
    pub period_s: f64,
    /// Time, s.
    pub time: Vec<f64>,
    /// Uninterrupted stretches: between gaps of the clock and changes of the `trajectory` channel.
    pub segments: Vec<Range<usize>>,
    /// Whether values are interpolated between rows, because the clock jitters.
    pub resampled: bool,
    channels: Vec<(Option<Quantity>, String, Vec<f64>)>,
}

impl EvenClock {
    /// Puts every channel of a recording on an even clock; where the clock jitters, values are interpolated linearly.
    ///
    /// # Errors
    /// `FRK-D009` when there is no clock.
    pub fn of(recording: &Recording) -> Result<Self> {
        Self::at(recording, None)
    }

    /// The same with a period (s) for a clock that jitters.
    ///
    /// # Errors
    /// As [`Self::of`].
    pub fn at(recording: &Recording, jittering_s: Option<f64>) -> Result<Self> {
        let time = recording.values(Quantity::Time).ok_or_else(|| {
            Error::new(&codes::MISSING_COLUMN, "a diagnosis needs the time of every sample")
                .in_file(recording.file())
                .in_column("time_s")
        })?;
        let grid = Grid::at(recording, time, jittering_s);
        let mut even = Self {
            period_s: grid.period_s,
            time: Vec::new(),
            segments: Vec::new(),
            resampled: grid.resampled,
            channels: Vec::new(),
        };
        for segment in &grid.segments {
            let begin = even.time.len();
            even.time.extend((0..segment.points).map(|i| segment.start_s + i as f64 * grid.period_s));
            even.segments.push(begin..even.time.len());
        }
        for channel in recording.channels.iter().filter(|channel| channel.quantity != Some(Quantity::Time)) {
            let mut values = Vec::with_capacity(even.time.len());
            grid.segments
                .iter()
                .for_each(|segment| values.extend_from_slice(&grid.values(segment, time, &channel.values)));
            even.channels.push((channel.quantity, channel.name.clone(), values));
        }
        Ok(even)
    }

    /// Values of a standard quantity.
    #[must_use]
    pub fn values(&self, quantity: Quantity) -> Option<&[f64]> {
        self.channels.iter().find(|(q, _, _)| *q == Some(quantity)).map(|(_, _, values)| values.as_slice())
    }

    /// Values of a channel by name.
    #[must_use]
    pub fn named(&self, name: &str) -> Option<&[f64]> {
        self.channels.iter().find(|(_, n, _)| n == name).map(|(_, _, values)| values.as_slice())
    }
}
