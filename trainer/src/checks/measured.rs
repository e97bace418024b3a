//! Whether torque, force or current was measured at all.

use crate::error::{Error, Result, codes};
use crate::joint::Joint;
use crate::recording::{Channel, Quantity, Recording};

/// Magnitude below which a number in the unit of its column is no measurement: smaller than any normal number of single precision
/// (IEEE 754), it is an integer or empty memory read as a float.
const SMALLEST_MEASURED: f64 = f32::MIN_POSITIVE as f64;
/// Distance of a position from a straight line over time, as a share of the way, up to which its speed is one.
const STRAIGHT: f64 = 0.01;

/// Refuses a torque that is nothing in every row, or the same in every row of a motion that is not steady. Beside a known inertia none is
/// right where the joint slows down: it coasts, or drops, and friction is what slows it.
pub(super) fn require(recording: &Recording, joint: &Joint) -> Result<()> {
    let Some(channel) = recording.separated_friction().or_else(|| recording.actuator()) else { return Ok(()) };
    let refuse = |message: &str, value: f64| {
        let error = Error::new(&codes::NOT_MEASURED, format!("the {} {message}", channel.name));
        Err(error.in_file(recording.file()).in_column(&channel.column).with_value(format!("{value:?}")))
    };
    let in_column_unit = |value: &f64| value / channel.si_per_column_unit;
    let largest = channel.values.iter().map(|value| in_column_unit(value).abs()).fold(0.0, f64::max);
    let first = channel.values.first().map_or(0.0, in_column_unit);
    let is_constant = channel.values.iter().all(|value| in_column_unit(value) == first);
    let has_inertia = joint.rigid_body.inertia_kgm2.is_some() || recording.channel(Quantity::RigidBodyTorque).is_some();
    if is_constant && first == 0.0 && has_inertia && recording.actuator().is_some() && changes_speed(recording) {
        return Ok(());
    }
    // A friction that somebody separated may be one Coulomb level.
    if is_constant && (first == 0.0 || recording.separated_friction().is_none() && changes_speed(recording)) {
        return refuse("is the same in every row: it was not measured", first);
    }
    if largest < SMALLEST_MEASURED {
        return refuse("holds no number that a converter gives: it was not measured", largest);
    }
    Ok(())
}

/// Whether a motion is recorded and is not one of constant speed, at which a constant torque may well be right.
fn changes_speed(recording: &Recording) -> bool {
    let (Some(time), Some(position)) = (recording.values(Quantity::Time), recording.values(Quantity::Position)) else {
        let velocity = recording.channel(Quantity::Velocity);
        return velocity.is_some_and(|Channel { values, .. }| values.iter().any(|value| *value != values[0]));
    };
    let (last, way) = (time.len() - 1, position[position.len() - 1] - position[0]);
    let line = |row: usize| position[0] + way * (time[row] - time[0]) / (time[last] - time[0]);
    (0..time.len()).any(|row| (position[row] - line(row)).abs() > STRAIGHT * way.abs())
}
