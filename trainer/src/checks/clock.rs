//! Whether the clock is one: its stamps advance, and its rate is one at which a joint is recorded.

use crate::error::{Error, Result, codes};
use crate::recording::{MINIMUM_ROWS, Quantity, Recording};

/// Rates of a motion recording, Hz. Above, every filter would be longer than memory is large: its length in rows grows with the rate; the
/// fastest drives sample currents at 100 to 200 kHz. Below, a recorded velocity has to confirm the clock.
const HIGHEST_RATE_HZ: f64 = 1e6;
const LOWEST_RATE_HZ: f64 = 1.0;
/// Ratio of the recorded velocity and the derivative of the position at which the clock is confirmed.
const CONFIRMED: std::ops::Range<f64> = 0.5..2.0;

/// Refuses a clock that stands still or runs at an impossible rate, before anything is put on it.
pub(super) fn require(recording: &Recording) -> Result<()> {
    let Some(clock) = recording.channel(Quantity::Time) else { return Ok(()) };
    let refuse = |code, message: String, value: f64| {
        let error = Error::new(code, message).in_file(recording.file()).in_column(&clock.column);
        Err(error.with_value(format!("{value:?}")))
    };
    if clock.values.len() < MINIMUM_ROWS {
        let message = format!("time has to advance in at least {MINIMUM_ROWS} rows");
        return refuse(&codes::TIME_NOT_INCREASING, message, clock.values.len() as f64);
    }
    // A joint that is recorded with its friction only needs no derivative, and so no clock.
    let Some(period_s) = recording.health.period_s.filter(|_| recording.channel(Quantity::Position).is_some()) else {
        return Ok(());
    };
    let median = period_s / clock.si_per_column_unit;
    let unit = &clock.column_unit;
    if period_s < 1.0 / HIGHEST_RATE_HZ {
        let message =
            format!("the time advances by {median:e} {unit} a row: no drive is sampled that fast, is it another unit?");
        return refuse(&codes::IMPLAUSIBLE_CLOCK, message, median);
    }
    if period_s > 1.0 / LOWEST_RATE_HZ && !is_confirmed(recording, &clock.values) {
        let message = format!(
            "the time advances by {median} {unit} a row, too slow for a motion: milli-, micro- or nanoseconds taken for {unit}?"
        );
        return refuse(&codes::IMPLAUSIBLE_CLOCK, message, median);
    }
    Ok(())
}

/// Whether a recorded velocity is the derivative of the position by this clock.
fn is_confirmed(recording: &Recording, time: &[f64]) -> bool {
    let (Some(position), Some(velocity)) = (recording.values(Quantity::Position), recording.values(Quantity::Velocity))
    else {
        return false;
    };
    let (mut both, mut derived) = (0.0, 0.0);
    for row in 1..time.len() - 1 {
        let derivative = (position[row + 1] - position[row - 1]) / (time[row + 1] - time[row - 1]);
        both += velocity[row] * derivative;
        derived += derivative * derivative;
    }
    derived > 0.0 && CONFIRMED.contains(&(both / derived))
}
