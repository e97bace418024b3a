//! Samples that are held: a channel that is new only every so many rows, and its rows at the rate that it really has.
//!
//! A coarse encoder repeats itself as well, but as soon as it moves by more than a step a row it is new in every row; a held one never
//! is.

use super::note::{Fault, Note};
use crate::numerics::resolution::resolution;
use crate::numerics::statistics::quantile;
use crate::recording::{Omission, Quantity, Recording};

/// Changes of at least this many steps of the converter tell a held channel from a coarse one.
const CLEAR_STEPS: f64 = 2.5;
/// Fewest of them.
const FEWEST_CHANGES: usize = 20;
/// Share of them that may follow a change in the row before.
const AT_ONCE: f64 = 0.02;
/// Share of them that has to come at one interval, within a row or a tenth of it: a command that steps now and then is not held.
const REGULAR: f64 = 0.8;
/// Longest time that a sample is held, s: below that rate no friction is seen.
const LONGEST_S: f64 = 0.25;

/// The rows at which the slowest of position and actuator is new.
pub(super) fn at_true_rate(recording: &Recording) -> Option<(Option<Recording>, Note)> {
    let period_s = recording.health.period_s?;
    let torque = recording.actuator().or_else(|| recording.separated_friction());
    let candidates = recording.channel(Quantity::Position).into_iter().chain(torque);
    let held = candidates.filter_map(|channel| Some((channel, interval(&channel.values)?)));
    let (channel, every) = held.max_by_key(|(_, every)| *every)?;
    if every as f64 * period_s > LONGEST_S {
        return None;
    }
    let fault = Fault::HeldSamples { channel: channel.name.clone(), every, rate_hz: 1.0 / (every as f64 * period_s) };
    let kept = fresh_rows(&channel.values, every);
    Some((Some(recording.clone().with_rows(&kept, Omission::Bridged)), Note::of_all(fault)))
}

/// Rows from one sample to the next, where a series is held.
fn interval(values: &[f64]) -> Option<usize> {
    let clear = CLEAR_STEPS * resolution(values).unwrap_or(0.0);
    let changed: Vec<usize> = (1..values.len()).filter(|row| values[*row] != values[row - 1]).collect();
    let large = |pair: &&[usize]| (values[pair[1]] - values[pair[1] - 1]).abs() >= clear;
    let intervals: Vec<usize> = changed.windows(2).filter(large).map(|pair| pair[1] - pair[0]).collect();
    let share = |is: &dyn Fn(usize) -> bool| {
        intervals.iter().filter(|interval| is(**interval)).count() as f64 / intervals.len() as f64
    };
    let usual = quantile(intervals.iter().map(|interval| *interval as f64), 0.5) as usize;
    let tolerance = (usual / 10).max(usize::from(usual > 2));
    let is_held = usual > 1
        && intervals.len() >= FEWEST_CHANGES
        && share(&|interval| interval == 1) < AT_ONCE
        && share(&|interval| interval.abs_diff(usual) <= tolerance) > REGULAR;
    is_held.then_some(usual)
}

/// The rows in which a held series is new; where it stands still, every so many rows.
fn fresh_rows(values: &[f64], every: usize) -> Vec<usize> {
    let Some(first) = (1..values.len()).find(|row| values[*row] != values[row - 1]) else { return Vec::new() };
    let mut kept = vec![first];
    let mut row = first;
    loop {
        let latest = row + every + every / 2;
        let change =
            (row + 1..=latest).take_while(|next| *next < values.len()).find(|next| values[*next] != values[next - 1]);
        row = change.unwrap_or(row + every);
        if row >= values.len() {
            return kept;
        }
        kept.push(row);
    }
}
