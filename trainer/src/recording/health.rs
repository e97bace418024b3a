//! Facts about clock, resolution and clipping of a recording. States them; judges nothing.

use super::{Channel, Quantity};
use crate::numerics::resolution::resolution_of_stretches;

/// A step of the clock above this many periods is a gap.
pub(crate) const GAP_PERIODS: f64 = 3.5;

/// A level that the actuator reaches in at least this share of the rows may be a limit.
const CLIPPED_SHARE: f64 = 0.005;

/// What can be said of a recording without a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Health {
    /// Median period of the clock, s; `None` without a clock.
    pub period_s: Option<f64>,
    /// Largest deviation of a step of the clock from the median period, gaps left out, as a share of it.
    pub jitter: f64,
    /// Indices of the rows that follow a gap: of the clock, or one of the interruptions.
    pub gaps: Vec<usize>,
    /// Indices of the rows before which the motion was interrupted whatever the clock says: rows were left out, or the position was
    /// set anew.
    pub interruptions: Vec<usize>,
    /// Rows whose standard channels other than time all equal those of the row before.
    pub repeated_rows: usize,
    /// Step of the encoder, rad or m; `None` where the position has no steps.
    pub position_resolution: Option<f64>,
    /// Rows in which the actuator stands exactly at its largest or smallest value, where that happens often.
    pub clipped_rows: usize,
    /// What else was noticed, one sentence each.
    pub notes: Vec<String>,
}

impl Health {
    /// Takes stock of the channels of a recording.
    pub(super) fn of(channels: &[Channel], notes: Vec<String>, interruptions: Vec<usize>) -> Self {
        let values = |wanted| channels.iter().find(|c| c.quantity == Some(wanted)).map(|c| c.values.as_slice());
        let mut health = Self { notes, interruptions, ..Self::default() };
        if let Some(time) = values(Quantity::Time) {
            health.take_clock(time);
        }
        health.position_resolution = values(Quantity::Position).and_then(|position| {
            let ends = health.interruptions.iter().copied().chain([position.len()]);
            let begins = [0].into_iter().chain(health.interruptions.iter().copied());
            resolution_of_stretches(begins.zip(ends).map(|(begin, end)| &position[begin..end]))
        });
        health.repeated_rows = repeated_rows(channels);
        let actuator = [Quantity::Torque, Quantity::Force, Quantity::Current].into_iter().find_map(values);
        health.clipped_rows = actuator.map_or(0, clipped_rows);
        health
    }

    fn take_clock(&mut self, time: &[f64]) {
        let steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let Some(period) = median(&steps) else { return };
        self.period_s = Some(period);
        for (index, step) in steps.iter().enumerate() {
            if *step > GAP_PERIODS * period || self.interruptions.binary_search(&(index + 1)).is_ok() {
                self.gaps.push(index + 1);
            } else {
                self.jitter = self.jitter.max((step - period).abs() / period);
            }
        }
    }
}

fn median(values: &[f64]) -> Option<f64> {
    let mut values = values.to_vec();
    let middle = values.len() / 2;
    (middle < values.len()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

fn repeated_rows(channels: &[Channel]) -> usize {
    let compared: Vec<&[f64]> = channels
        .iter()
        .filter(|channel| channel.quantity.is_some_and(|quantity| quantity != Quantity::Time))
        .map(|channel| channel.values.as_slice())
        .collect();
    let rows = compared.first().map_or(0, |values| values.len());
    (1..rows).filter(|row| compared.iter().all(|v| v[*row].to_bits() == v[row - 1].to_bits())).count()
}

fn clipped_rows(values: &[f64]) -> usize {
    let highest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let lowest = values.iter().copied().fold(f64::INFINITY, f64::min);
    if highest <= lowest {
        return 0;
    }
    let enough = CLIPPED_SHARE * values.len() as f64;
    [highest, lowest]
        .into_iter()
        .map(|level| values.iter().filter(|value| value.to_bits() == level.to_bits()).count())
        .filter(|count| *count as f64 > enough)
        .sum()
}
