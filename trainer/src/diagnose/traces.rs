//! What a report draws: torque, residuals before and after, the torque of each effect and every channel, at working rows.

use super::channel::Channel;
use super::conclude::{Refit, weighted};
use super::localise::{Region, locate_density};
use super::prove::rest;
use super::search::Search;
use crate::physics::quantile;

/// Series at the working rows behind the common filter; all of one length.
#[derive(Clone, Debug, Default)]
pub struct Traces {
    /// Time in s.
    pub time: Vec<f64>,
    /// Velocity in rad/s or m/s.
    pub velocity: Vec<f64>,
    /// Recorded actuator torque.
    pub torque: Vec<f64>,
    /// What the refitted base model leaves.
    pub before: Vec<f64>,
    /// What base and effects leave together.
    pub after: Vec<f64>,
    /// Torque of each finding, in their order.
    pub effects: Vec<Vec<f64>>,
    /// Whether the row was locked away from fitting and choosing.
    pub locked: Vec<bool>,
    /// Channels and derived axes that vary, by name.
    pub channels: Vec<(&'static str, Vec<f64>)>,
    /// First row of each uninterrupted run, ascending.
    pub run_starts: Vec<usize>,
}

/// Root mean square that sticks out among those of the locked stretches, over their median: the noise of fast motion is twice
/// that of slow motion.
const STICKS_OUT: f64 = 3.0;

impl Traces {
    /// Traces of a finished search.
    pub(crate) fn of(search: &Search, baseline: &Refit, improved: &Refit) -> Self {
        let prepared = search.prepared;
        let state = &prepared.state;
        let mut locked = vec![false; prepared.rows.len()];
        let mut run_starts = Vec::new();
        for block in &prepared.blocks {
            for run in &block.runs {
                run_starts.push(run.start);
                locked[run.clone()].fill(block.locked);
            }
        }
        run_starts.sort_unstable();
        let effects = improved
            .effects
            .iter()
            .map(|effect| weighted(&search.filtered_columns(&effect.label, &effect.shape), &effect.coefficients))
            .collect();
        let channels = Channel::axes(state)
            .into_iter()
            .filter_map(|channel| Some((channel.name(), prepared.at_rows(&channel.series(state)?))))
            .filter(|(_, values)| varies(values))
            .collect();
        Self {
            time: prepared.at_rows(&state.time),
            velocity: prepared.at_rows(&state.velocity),
            torque: prepared.filtered(&prepared.torque),
            before: rest(search, baseline),
            after: rest(search, improved),
            effects,
            locked,
            channels,
            run_starts,
        }
    }

    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Values of a channel; velocity keeps its sign.
    #[must_use]
    pub fn channel(&self, name: &str) -> Option<&[f64]> {
        if name == "velocity" {
            return Some(&self.velocity);
        }
        self.channels.iter().find(|(channel, _)| *channel == name).map(|(_, values)| values.as_slice())
    }

    /// Whether one of the locked stretches is left with far more than the others: what happened there once, no open row saw.
    #[must_use]
    pub fn locked_stretch_sticks_out(&self) -> bool {
        let ends = self.run_starts.iter().skip(1).copied().chain([self.len()]);
        let left: Vec<f64> = self
            .run_starts
            .iter()
            .zip(ends)
            .filter(|(start, _)| self.locked[**start])
            .map(|(start, end)| {
                let rest = &self.after[*start..end];
                (rest.iter().map(|r| r * r).sum::<f64>() / rest.len() as f64).sqrt()
            })
            .collect();
        let largest = left.iter().copied().fold(0.0, f64::max);
        !left.is_empty() && largest > STICKS_OUT * quantile(left.into_iter(), 0.5)
    }

    /// Where all effects together lower the squared residual: regions, sharpest first, and stretches of time in s.
    #[must_use]
    pub fn excess(&self) -> (Vec<Region>, Vec<[f64; 2]>) {
        let density: Vec<f64> = self.before.iter().zip(&self.after).map(|(b, a)| b * b - a * a).collect();
        let axes: Vec<(&'static str, &[f64])> = std::iter::once(("velocity", self.velocity.as_slice()))
            .chain(self.channels.iter().map(|(name, values)| (*name, values.as_slice())))
            .collect();
        let location = locate_density(&axes, &self.time, &density);
        (location.regions, location.when_s)
    }
}

fn varies(values: &[f64]) -> bool {
    values.iter().any(|value| *value != values[0])
}
