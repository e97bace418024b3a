//! A joint that only ever moves one way: friction and offset are one.

use crate::checks::motion::smooth;
use crate::checks::note::{Fault, Note};
use crate::numerics::statistics::{mean, quantile};
use crate::recording::{Quantity, Recording};
use crate::samples::VelocitySource;

/// Longest way back as a share of all the way, below which the joint never turns round: it settles, or the encoder scatters.
const NO_RETURN: f64 = 0.02;

/// Notes a motion in one direction.
pub(in crate::checks) fn one_direction(recording: &Recording) -> Option<Note> {
    recording.actuator().or_else(|| recording.separated_friction())?;
    let (share, forward) = match smooth(recording, VelocitySource::Derived) {
        Some(samples) => longest_return(samples.position.as_deref()?),
        None => {
            let velocity = recording.values(Quantity::Velocity)?;
            (lesser_share(velocity), mean(velocity) > 0.0)
        }
    };
    (share < NO_RETURN).then(|| Note::of_all(Fault::OneDirection { forward }))
}

/// Longest way back, in the direction in which it is shorter, over the range of a position, and whether that is the negative one; a half
/// where it does not change.
fn longest_return(position: &[f64]) -> (f64, bool) {
    let (mut highest, mut lowest) = (f64::NEG_INFINITY, f64::INFINITY);
    let (mut down, mut up) = (0.0_f64, 0.0_f64);
    for q in position {
        highest = highest.max(*q);
        lowest = lowest.min(*q);
        down = down.max(highest - q);
        up = up.max(q - lowest);
    }
    let range = quantile(position.iter().copied(), 1.0) - quantile(position.iter().copied(), 0.0);
    (if range > 0.0 { down.min(up) / range } else { 0.5 }, down < up)
}

/// Share of the travel that goes in the direction of less travel; a half where both are alike or nothing moves.
pub(in crate::checks) fn lesser_share(velocity: &[f64]) -> f64 {
    let forward: f64 = velocity.iter().filter(|v| **v > 0.0).sum();
    let back: f64 = -velocity.iter().filter(|v| **v < 0.0).sum::<f64>();
    if forward + back > 0.0 { forward.min(back) / (forward + back) } else { 0.5 }
}
