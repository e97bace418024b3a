//! A position in degrees whose column says radians, told by gravity: it repeats after a turn.

use super::law::{Columns, PositionTerms};
use super::motion::{smooth, top_speed};
use super::note::{Fault, Note, WrongUnit};
use crate::numerics::statistics::quantile;
use crate::recording::{Axis, Recording};
use crate::samples::VelocitySource;

/// Least travel of the position as it is recorded: in degrees a joint hardly moves below it.
const LEAST_TRAVEL: f64 = 20.0;
/// What a law over degrees leaves over what a law over radians and what a quadratic leave, root mean square, at most: a torque that
/// changes slowly with the position is described by the quadratic as well.
const CLEARLY_BETTER: f64 = 0.5;

/// Notes a position in degrees.
pub(super) fn position_in_degrees(recording: &Recording) -> Option<Note> {
    if recording.axis != Axis::Rotary {
        return None;
    }
    let samples = smooth(recording, VelocitySource::Derived)?;
    let position = samples.position.as_deref()?;
    let travel = quantile(position.iter().copied(), 1.0) - quantile(position.iter().copied(), 0.0);
    if travel < LEAST_TRAVEL {
        return None;
    }
    let top = top_speed(samples.velocity.as_deref()?);
    let left = |terms| Some(Columns::of(&samples, top, terms)?.fit(&samples, top)?.fit.rmse);
    let degrees = left(PositionTerms::Gravity(1f64.to_radians()))?;
    let others = left(PositionTerms::Gravity(1.0))?.min(left(PositionTerms::Quadratic)?);
    let share = degrees / others;
    (share < CLEARLY_BETTER).then(|| Note::of_all(Fault::WrongUnit(WrongUnit::PositionInDegrees(share))))
}
