//! A position that starts anew after each turn of the encoder, and its turns put together again.

use super::note::{Fault, Note};
use crate::joint::Joint;
use crate::numerics::statistics::quantile;
use crate::recording::{Axis, Quantity, Recording};
use std::f64::consts::{PI, TAU};

/// A step of more than this share of the whole range is a jump across it.
const JUMP_SHARE: f64 = 0.5;
/// Deviation of a jump from a turn, as a share of it, beside twice the largest step of the motion.
const TOLERANCE: f64 = 0.005;
/// Share of the jumps that have to go against the motion before and after, where the turn is not known.
const AGAINST_MOTION: f64 = 0.9;

/// The recording with its position, and its link position where that wraps at the same turn, unwrapped.
pub(super) fn unwrapped(recording: &Recording, joint: &Joint) -> Option<(Option<Recording>, Note)> {
    let position = recording.values(Quantity::Position)?;
    let jumps = jumps(position);
    let period = turn(&jumps, largest_step(position), &known_turns(recording, joint))?;
    let time = recording.values(Quantity::Time)?;
    let when_s: Vec<[f64; 2]> = jumps.iter().map(|jump| [time[jump.row]; 2]).collect();
    let mut mended = recording.clone().with_values(Quantity::Position, unwrap(position, period));
    if let Some(link) = recording.values(Quantity::LinkPosition) {
        mended = mended.with_values(Quantity::LinkPosition, unwrap(link, period));
    }
    let fault = Fault::WrappedPosition { period, times: jumps.len() };
    Some((Some(mended), Note { fault, when_s }))
}

/// A step across most of the range of the position.
struct Jump {
    row: usize,
    /// Beyond what the motion beside it makes a row.
    height: f64,
    motion: f64,
}

fn jumps(position: &[f64]) -> Vec<Jump> {
    let range = quantile(position.iter().copied(), 1.0) - quantile(position.iter().copied(), 0.0);
    let step = |row: usize| position[row] - position[row - 1];
    let jump = |row: usize| {
        let beside = [row.wrapping_sub(2), row.wrapping_sub(1), row + 1, row + 2];
        let motion = quantile(beside.into_iter().filter(|row| (1..position.len()).contains(row)).map(step), 0.5);
        Jump { row, height: step(row) - motion, motion }
    };
    (1..position.len()).filter(|row| step(*row).abs() > JUMP_SHARE * range).map(jump).collect()
}

/// Largest step that is no jump.
fn largest_step(position: &[f64]) -> f64 {
    let range = quantile(position.iter().copied(), 1.0) - quantile(position.iter().copied(), 0.0);
    let steps = position.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    steps.filter(|step| *step <= JUMP_SHARE * range).fold(0.0, f64::max)
}

/// Turns at which encoders start anew: of the joint, of the motor, and of an angle between -90 and 90 degrees.
fn known_turns(recording: &Recording, joint: &Joint) -> Vec<f64> {
    if recording.axis != Axis::Rotary {
        return Vec::new();
    }
    let of_motor = joint.drive.gear_ratio.map(|ratio| TAU / ratio.abs());
    [Some(TAU), of_motor, Some(PI)].into_iter().flatten().collect()
}

/// The travel after which the position starts anew: that of all jumps.
fn turn(jumps: &[Jump], largest_step: f64, known: &[f64]) -> Option<f64> {
    if jumps.is_empty() {
        return None;
    }
    let are_all = |period: f64| {
        jumps.iter().all(|jump| (jump.height.abs() - period).abs() < TOLERANCE * period + 2.0 * largest_step)
    };
    if let Some(period) = known.iter().copied().find(|period| are_all(*period)) {
        return Some(period);
    }
    let usual = quantile(jumps.iter().map(|jump| jump.height.abs()), 0.5);
    let against = jumps.iter().filter(|jump| jump.height * jump.motion < 0.0).count() as f64;
    (jumps.len() > 1 && are_all(usual) && against >= AGAINST_MOTION * jumps.len() as f64).then_some(usual)
}

/// Adds a turn wherever a step of more than half a turn shows that one was taken off.
fn unwrap(position: &[f64], period: f64) -> Vec<f64> {
    let mut turns = 0.0;
    let mut before = position.first().copied().unwrap_or(0.0);
    let mut put_together = |value: f64| {
        turns -= ((value - before) / period).round();
        before = value;
        value + turns * period
    };
    position.iter().map(|value| put_together(*value)).collect()
}
