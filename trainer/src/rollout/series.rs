//! What an actuator was told over a recording.

use crate::actuator::{Actuator, Command, Kind, RateLimited};
use crate::error::{Error, Result, codes};
use crate::recording::{Quantity, Recording};
use std::ops::Range;

/// Commands of a recording, one a row.
#[derive(Clone, Debug)]
pub struct Series {
    /// Time of the rows, s.
    pub time: Vec<f64>,
    /// What was commanded at each row, the delay of the actuator not counted; between two rows it lies on a line. Where the drive holds a command
    /// until the next one, half the time between them is a part of the delay.
    pub commands: Vec<Command>,
    /// Degrees Celsius, one a row; empty where nobody measured it.
    pub temperature: Vec<f64>,
}

impl Series {
    /// Reads the commands of a recording for an actuator.
    ///
    /// # Errors
    /// `FRK-D009` where a column is missing that the actuator follows, `FRK-D014` where a constant is neither in joint.toml nor a column.
    pub fn of(recording: &Recording, actuator: &Actuator) -> Result<Self> {
        Self::of_rows(recording, actuator, &(0..recording.len()))
    }

    /// The same of some rows; a reference that moves no faster than the firmware lets it begins anew at the first of them.
    ///
    /// # Errors
    /// As [`Self::of`].
    pub(super) fn of_rows(recording: &Recording, actuator: &Actuator, rows: &Range<usize>) -> Result<Self> {
        let kind = actuator.kind;
        let purpose = format!("an actuator of kind `{}`", kind.name());
        let time = recording.require(&[Quantity::Time], &purpose)?.values[rows.clone()].to_vec();
        let column = |quantity| recording.values(quantity).map(|values| &values[rows.clone()]);
        let mut effort: Option<&[f64]> = None;
        let mut is_voltage = false;
        match kind {
            Kind::Torque => {
                let any = [Quantity::Torque, Quantity::Force, Quantity::Current];
                effort = Some(&recording.require(&any, &purpose)?.values[rows.clone()]);
            }
            Kind::Current => effort = Some(&recording.require(&[Quantity::Current], &purpose)?.values[rows.clone()]),
            Kind::DcMotor => {
                let either = recording.require(&[Quantity::Duty, Quantity::Voltage], &purpose)?;
                is_voltage = either.quantity == Some(Quantity::Voltage);
                effort = Some(&either.values[rows.clone()]);
            }
            Kind::Pd | Kind::PositionServo => {
                recording.require(&[Quantity::ReferencePosition], &purpose)?;
            }
        }
        let supply = if is_voltage { None } else { column(Quantity::Voltage) };
        let needs_supply = kind.is_motor() && !is_voltage && supply.is_none();
        let missing = |name: &str, what: &str| {
            let message = format!("{purpose} needs {what}: as `{name}` under [actuator] of joint.toml, or as a column");
            Error::new(&codes::MISSING_PARAMETER, message)
                .in_column(format!("actuator.{name}"))
                .in_file(recording.file())
        };
        if needs_supply && actuator.supply.is_nan() {
            return Err(missing("supply_V", "the voltage of its supply"));
        }
        if kind == Kind::PositionServo && actuator.error_gain <= 0.0 {
            return Err(missing("firmware_error_gain", "the duty that its firmware makes of a position error"));
        }
        let reference = column(Quantity::ReferencePosition).map(|values| rate_limited(&time, values, actuator));
        let at = |values: Option<&[f64]>, row: usize, otherwise: f64| values.map_or(otherwise, |values| values[row]);
        let commands = (0..time.len()).map(|row| Command {
            effort: at(effort, row, 0.0),
            is_voltage,
            reference: at(reference.as_deref(), row, 0.0),
            reference_velocity: at(column(Quantity::ReferenceVelocity), row, 0.0),
            feed_forward: at(column(Quantity::FeedForward), row, 0.0),
            supply: at(supply, row, actuator.supply),
            kp: at(column(Quantity::Kp), row, actuator.kp),
            enabled: at(column(Quantity::TorqueEnabled), row, 1.0) >= 0.5,
        });
        Ok(Self {
            commands: commands.collect(),
            temperature: column(Quantity::Temperature).map(<[f64]>::to_vec).unwrap_or_default(),
            time,
        })
    }

    /// One command for so many rows.
    #[cfg(test)]
    pub(super) fn held(command: Command, period_s: f64, rows: usize) -> Self {
        let time = (0..rows).map(|row| period_s * row as f64).collect();
        Self { time, commands: vec![command; rows], temperature: Vec::new() }
    }

    /// What acts at a time, s, that lies at or after that of `row` and before the next; `row` may be moved back by a delay.
    #[must_use]
    pub fn at(&self, time: f64, near: usize) -> Command {
        let mut row = near.min(self.time.len().saturating_sub(1));
        while row > 0 && self.time[row] > time {
            row -= 1;
        }
        let command = self.commands[row];
        let Some((next, after)) = self.commands.get(row + 1).zip(self.time.get(row + 1)) else { return command };
        let share = ((time - self.time[row]) / (after - self.time[row])).clamp(0.0, 1.0);
        let between = |of: fn(&Command) -> f64| of(&command) + share * (of(next) - of(&command));
        Command {
            effort: between(|command| command.effort),
            reference: between(|command| command.reference),
            reference_velocity: between(|command| command.reference_velocity),
            feed_forward: between(|command| command.feed_forward),
            supply: between(|command| command.supply),
            ..command
        }
    }
}

/// A reference that moves no faster than the firmware lets it.
fn rate_limited(time: &[f64], reference: &[f64], actuator: &Actuator) -> Vec<f64> {
    let mut limited = RateLimited::new(actuator.velocity_limit);
    let mut before = time.first().copied().unwrap_or(0.0);
    let follow = |(now, wanted): (&f64, &f64)| limited.follow(*wanted, now - std::mem::replace(&mut before, *now));
    time.iter().zip(reference).map(follow).collect()
}
