//! A torque that stands still, at zero or at its last value, while the joint moves: a channel that dropped out.
//!
//! A drive that is switched off gives no torque either, one at its limit a constant one, and a coarse converter repeats itself: a
//! law fitted to all other rows tells whether the torque had to change there.

use super::law::{Columns, PositionTerms};
use super::motion::{smooth, top_speed};
use super::note::{Fault, Note};
use super::rows::{others, stretches};
use crate::numerics::resolution::resolution;
use crate::numerics::statistics::quantile;
use crate::recording::{Omission, Quantity, Recording};
use crate::samples::VelocitySource;
use std::ops::Range;

/// Rows that a stretch has at least, also over those that are usual: of a fine torque no two neighbours are equal.
const FEWEST_ROWS: usize = 10;
const OVER_USUAL: f64 = 5.0;
/// Share of the lengths of equal values that are usual.
const USUAL: f64 = 0.9;
/// Speed over the top speed, mean over the stretch, from which the joint moves.
const MOVING: f64 = 0.05;
/// Distance of the law from the value over what the law leaves elsewhere, root mean square, at least.
const OVER_RESIDUAL: f64 = 4.0;
/// The same over the step of the converter: within it a torque that changes is recorded as one that does not.
const OVER_STEP: f64 = 1.5;
/// Share of a stretch in which the law asks for more than a limit gives.
const AT_LIMIT: f64 = 0.9;
/// Share of the rows that may be left out: beyond it the rest is no recording.
const MOST_LEFT_OUT: f64 = 0.8;

/// The recording without the rows in which the torque stands still although it must not.
pub(super) fn without_frozen_torque(recording: &Recording) -> Option<(Option<Recording>, Note)> {
    let torque = &recording.separated_friction().or_else(|| recording.actuator())?.values;
    let time = recording.values(Quantity::Time)?;
    let candidates = constant_runs(torque);
    let rows_of = |runs: &[Range<usize>]| runs.iter().cloned().flatten().collect::<Vec<usize>>();
    let kept = others(recording.len(), &rows_of(&candidates));
    if candidates.is_empty() || (kept.len() as f64) < (1.0 - MOST_LEFT_OUT) * recording.len() as f64 {
        return None;
    }
    let all = smooth(recording, VelocitySource::Derived)?;
    let rest = smooth(&recording.clone().with_rows(&kept, Omission::Interrupted), VelocitySource::Derived)?;
    let velocity = all.velocity.as_deref()?;
    let top = top_speed(velocity);
    let terms = PositionTerms::Gravity(1.0);
    let fit = Columns::of(&rest, top, terms)?.fit(&rest, top)?.fit;
    let law = Columns::of(&all, top, terms)?.predict(&fit.coefficients);
    let least = (OVER_RESIDUAL * fit.rmse).max(OVER_STEP * resolution(torque).unwrap_or(0.0));
    let is_frozen = |run: &Range<usize>| {
        let value = torque[run.start];
        let begin = all.time.partition_point(|at| *at < time[run.start]);
        let end = all.time.partition_point(|at| *at <= time[run.end - 1]);
        // A stretch between two samples is judged by the one that follows.
        let samples = begin.min(all.len() - 1)..end.clamp(begin + 1, all.len().max(begin + 1)).min(all.len());
        let count = samples.len().max(1) as f64;
        let mean = |of: &dyn Fn(usize) -> f64| samples.clone().map(of).sum::<f64>() / count;
        let distance = mean(&|sample| (law[sample] - value).powi(2)).sqrt();
        let beyond = mean(&|sample| f64::from(law[sample] * value.signum() > value.abs() && value != 0.0));
        mean(&|sample| velocity[sample].abs()) > MOVING * top && distance > least && beyond < AT_LIMIT
    };
    let frozen: Vec<Range<usize>> = candidates.into_iter().filter(is_frozen).collect();
    let first = torque[frozen.first()?.start];
    let value = frozen.iter().all(|run| torque[run.start] == first).then_some(first);
    let rows = rows_of(&frozen);
    let mended = recording.clone().with_rows(&others(recording.len(), &rows), Omission::Interrupted);
    let note = Note { fault: Fault::FrozenTorque { rows: rows.len(), value }, when_s: stretches(recording, &rows) };
    Some((Some(mended), note))
}

/// Stretches of one value that are much longer than is usual for this channel, those at its highest and lowest value left out: there a
/// limit holds it.
fn constant_runs(values: &[f64]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    let mut start = 0;
    for row in 1..=values.len() {
        if row == values.len() || values[row] != values[start] {
            runs.push(start..row);
            start = row;
        }
    }
    let usual = quantile(runs.iter().map(|run| run.len() as f64), USUAL);
    let least = (OVER_USUAL * usual).max(FEWEST_ROWS as f64);
    let [lowest, highest] = [0.0, 1.0].map(|share| quantile(values.iter().copied(), share));
    let is_limit = |value: f64| value != 0.0 && (value == lowest || value == highest);
    runs.retain(|run| run.len() as f64 >= least && !is_limit(values[run.start]));
    runs
}
