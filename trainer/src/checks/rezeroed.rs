//! A position that was set anew in the run: it jumps while the motion goes on.

use super::note::{Fault, Note};
use crate::numerics::resolution::resolution;
use crate::numerics::statistics::quantile;
use crate::recording::{Quantity, Recording};

/// Most jumps that are taken for settings anew; more are a fault of another kind.
const MOST: usize = 5;
/// A jump over the largest step of any other row, and over the largest change of step of any other row, at least: no joint goes that fast
/// for one row.
const OVER_STEPS: f64 = 1.5;
const OVER_CHANGES: f64 = 4.0;
/// The same over the resolution of the encoder.
const OVER_RESOLUTION: f64 = 8.0;
/// Rows within which a jump that is taken back is a glitch.
const GLITCH: usize = 4;
/// Share of a jump that is taken back by then.
const TAKEN_BACK: f64 = 0.5;
/// Share of a jump that a recorded velocity may account for.
const WITNESSED: f64 = 0.3;

/// The recording with the position shifted back after each jump, so that the motion goes on, and interrupted there.
pub(super) fn put_back(recording: &Recording) -> Option<(Option<Recording>, Note)> {
    let (time, position) = (recording.values(Quantity::Time)?, recording.values(Quantity::Position)?);
    let found = jumps(recording, time, position);
    let (first, largest) = (found.first()?, found.iter().max_by(|a, b| a.height.abs().total_cmp(&b.height.abs()))?);
    let by = if found.len() == 1 { first.height } else { largest.height };
    let mut put_back = position.to_vec();
    for jump in &found {
        put_back[jump.row..].iter_mut().for_each(|value| *value -= jump.height);
    }
    let rows: Vec<usize> = found.iter().map(|jump| jump.row).collect();
    let mended = recording.clone().with_values(Quantity::Position, put_back).with_interruptions(&rows);
    let when_s = rows.iter().map(|row| [time[*row]; 2]).collect();
    Some((Some(mended), Note { fault: Fault::RezeroedPosition { by }, when_s }))
}

#[derive(Clone, Copy)]
struct Jump {
    row: usize,
    height: f64,
}

fn jumps(recording: &Recording, time: &[f64], position: &[f64]) -> Vec<Jump> {
    let least_of_encoder = OVER_RESOLUTION * resolution(position).unwrap_or(0.0);
    let gaps = &recording.health.gaps;
    let is_gap = |row: usize| gaps.binary_search(&row).is_ok();
    let speed = |row: usize| (position[row] - position[row - 1]) / (time[row] - time[row - 1]);
    let rows = (1..position.len()).filter(|row| !is_gap(*row));
    // Beyond what the motion beside a row makes in its time.
    let change = |row: usize| {
        let beside = [row.wrapping_sub(2), row.wrapping_sub(1), row + 1, row + 2];
        let beside = beside.into_iter().filter(|row| (1..position.len()).contains(row) && !is_gap(*row));
        let motion = quantile(beside.map(speed), 0.5) * (time[row] - time[row - 1]);
        position[row] - position[row - 1] - motion
    };
    let mut changes: Vec<Jump> = rows.map(|row| Jump { row, height: change(row) }).collect();
    changes.sort_by(|a, b| b.height.abs().total_cmp(&a.height.abs()));
    // The fewest jumps that all stand out of everything else.
    let found = (1..=MOST.min(changes.len().saturating_sub(1))).find_map(|count| {
        let found = &changes[..count];
        let is_other = |row: &usize| found.iter().all(|jump| jump.row.abs_diff(*row) > 2);
        let others = || changes.iter().filter(|jump| is_other(&jump.row));
        let largest_change = others().map(|jump| jump.height.abs()).next()?;
        let largest_step = others().map(|jump| (position[jump.row] - position[jump.row - 1]).abs()).fold(0.0, f64::max);
        let least = (OVER_STEPS * largest_step).max(OVER_CHANGES * largest_change).max(least_of_encoder);
        found.iter().all(|jump| jump.height.abs() > least).then(|| found.to_vec())
    });
    let mut found = found.unwrap_or_default();
    found.sort_by_key(|jump| jump.row);
    let is_taken_back = |jump: &Jump| {
        let near = jump.row.saturating_sub(GLITCH).max(1)..(jump.row + GLITCH + 1).min(position.len());
        near.map(change).sum::<f64>().abs() < TAKEN_BACK * jump.height.abs()
    };
    let velocity = recording.values(Quantity::Velocity);
    let is_motion = |jump: &Jump| {
        velocity.is_some_and(|v| {
            let speed = v[jump.row - 1].abs().min(v[jump.row].abs());
            speed * (time[jump.row] - time[jump.row - 1]) > WITNESSED * jump.height.abs()
        })
    };
    found.iter().filter(|jump| !is_taken_back(jump) && !is_motion(jump)).copied().collect()
}
