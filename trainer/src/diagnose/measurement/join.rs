//! Several recordings of one joint as one: what was recorded first and what was recorded after advice.

use crate::diagnose::measurement::signals::Signals;
use crate::samples::spikes::Spikes;

/// Why two recordings cannot be taken together.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Unjoinable {
    /// The sample rates differ.
    #[error("this is sampled every {next} s, the recording before it every {first} s; resample one of them")]
    Period {
        /// Period of the first in s.
        first: f64,
        /// Period of the next in s.
        next: f64,
    },
}

/// Relative difference of two sample periods up to which recordings are joined. Chosen by judgement: clocks of one
/// drive differ by less than 100 ppm; more scales every derivative of one of them.
const PERIOD_TOLERANCE: f64 = 1e-3;

/// By how much (s) the times of a later recording move where it is put behind an earlier one: a clock that began anew goes on a period
/// after the last row; nothing where it went on by itself, or nothing lies before it.
pub(crate) fn follow_s(before: &[f64], next: &[f64], period_s: f64) -> f64 {
    match (before.last(), next.first()) {
        (Some(end), Some(begin)) if begin <= end => end + period_s - begin,
        _ => 0.0,
    }
}

impl Signals {
    /// Puts another measurement of the same motion behind this one, with its own times.
    ///
    /// # Errors
    /// As [`Self::append`].
    pub fn repeated(mut self, other: Signals) -> Result<Self, Unjoinable> {
        let time = other.time.clone();
        self.append(other)?;
        let begin = self.time.len() - time.len();
        self.time[begin..].copy_from_slice(&time);
        Ok(self)
    }

    /// Puts a later recording of the same joint behind this one. Where its clock began anew it is taken to follow at
    /// once; a channel that only one of both has is dropped.
    ///
    /// # Errors
    /// [`Unjoinable`] when the sample rates differ.
    pub fn append(&mut self, next: Signals) -> Result<(), Unjoinable> {
        if (next.period / self.period - 1.0).abs() > PERIOD_TOLERANCE {
            return Err(Unjoinable::Period { first: self.period, next: next.period });
        }
        let count = self.time.len();
        let shift = follow_s(&self.time, &next.time, self.period);
        self.time.extend(next.time.iter().map(|time| time + shift));
        self.position.extend(next.position);
        self.torque.extend(next.torque);
        self.segments.extend(next.segments.into_iter().map(|segment| segment.start + count..segment.end + count));
        for (series, with) in [
            (&mut self.velocity, next.velocity),
            (&mut self.rigid_body, next.rigid_body),
            (&mut self.load, next.load),
            (&mut self.temperature, next.temperature),
            (&mut self.link_position, next.link_position),
        ] {
            *series = series.take().zip(with).map(|(mut before, after)| {
                before.extend(after);
                before
            });
        }
        self.commanded = self.commanded.take().zip(next.commanded).map(|(mut before, after)| {
            before.append(after);
            before
        });
        self.other_positions.truncate(next.other_positions.len());
        for (series, with) in self.other_positions.iter_mut().zip(next.other_positions) {
            series.extend(with);
        }
        self.spikes.extend(next.spikes.into_iter().map(|spikes| Spikes { time_s: spikes.time_s + shift, ..spikes }));
        self.position_resolution = self.position_resolution.max(next.position_resolution);
        self.resampled |= next.resampled;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(start: f64, count: usize, temperature: bool) -> Signals {
        Signals {
            period: 0.01,
            time: (0..count).map(|i| start + 0.01 * i as f64).collect(),
            position: vec![0.5; count],
            torque: vec![1.0; count],
            temperature: temperature.then(|| vec![20.0; count]),
            segments: vec![0..count],
            ..Signals::default()
        }
    }

    #[test]
    fn a_later_clock_is_kept_and_a_new_one_follows_at_once() {
        for (start, expected) in [(100.0, 100.0), (0.0, 1.0)] {
            let mut both = part(0.0, 100, true);
            let spikes = Spikes { channel: "torque".into(), rows: 1, time_s: start + 0.2, height: 3.0, unit: "N m" };
            both.append(Signals { spikes: vec![spikes], ..part(start, 50, true) }).unwrap();
            assert!((both.spikes[0].time_s - expected - 0.2).abs() < 1e-9, "a glitch is told at its time");
            assert!((both.time[100] - expected).abs() < 1e-9);
            assert!(both.time.windows(2).all(|pair| pair[1] > pair[0]));
            assert_eq!((both.torque.len(), both.segments.clone()), (150, vec![0..100, 100..150]));
            assert_eq!(both.temperature.map(|series| series.len()), Some(150));
        }
    }

    #[test]
    fn a_channel_of_one_is_dropped_and_another_rate_refused() {
        let mut both = part(0.0, 100, true);
        both.append(part(0.0, 50, false)).unwrap();
        assert!(both.temperature.is_none());
        let other = Signals { period: 0.02, ..part(0.0, 50, true) };
        assert!(both.append(other).is_err());
    }
}
