//! Whether torque, force or current was measured at all.

use crate::error::{Error, Result, codes};
use crate::recording::Recording;

/// Magnitude below which a number in the unit of its column is no measurement: smaller than any normal number of single precision
/// (IEEE 754), it is an integer or empty memory read as a float.
const SMALLEST_MEASURED: f64 = f32::MIN_POSITIVE as f64;

/// Refuses a torque that is the same, or nothing, in every row.
pub(super) fn require(recording: &Recording) -> Result<()> {
    let Some(channel) = recording.separated_friction().or_else(|| recording.actuator()) else { return Ok(()) };
    let first = channel.values.first().copied().unwrap_or(0.0);
    let refuse = |message: &str, value: f64| {
        let error = Error::new(&codes::NOT_MEASURED, format!("the {} {message}", channel.name));
        Err(error.in_file(recording.file()).in_column(&channel.column).with_value(format!("{value:?}")))
    };
    let column_unit = |value: &f64| (value / channel.si_per_column_unit).abs();
    if channel.values.iter().all(|value| *value == first) {
        return refuse("is the same in every row: it was not measured", first / channel.si_per_column_unit);
    }
    let largest = channel.values.iter().map(column_unit).fold(0.0, f64::max);
    if largest < SMALLEST_MEASURED {
        return refuse("holds no number that a converter gives: it was not measured", largest);
    }
    Ok(())
}
