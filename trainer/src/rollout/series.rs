//! What an actuator was told over a recording.

use crate::actuator::{Actuator, Command, Kind, RateLimited};
use crate::error::{Error, Result, codes};
use crate::numerics::Number;
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
            kp: column(Quantity::Kp).map(|values| values[row]),
            enabled: at(column(Quantity::TorqueEnabled), row, 1.0) >= 0.5,
        });
        Ok(Self {
            commands: commands.collect(),
            temperature: column(Quantity::Temperature).map(<[f64]>::to_vec).unwrap_or_default(),
            time,
        })
    }

    /// The same with `times` rows in place of one, between which the commands lie on a cubic curve through the rows about them (Catmull & Rom 1974), and
    /// the places of its rows. Before a row of `begun`, ascending, nothing is put: the motion begins anew there.
    #[must_use]
    pub(crate) fn on_a_curve(&self, times: usize, begun: &[usize]) -> (Self, Vec<usize>) {
        let (mut time, mut commands, mut temperature, mut places) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let is_end = |row: usize| row + 1 >= self.time.len() || begun.binary_search(&(row + 1)).is_ok();
        let after = |row: usize| if is_end(row) { row } else { row + 1 };
        for row in 0..self.time.len() {
            places.push(time.len());
            let before = if row == 0 || is_end(row - 1) { row } else { row - 1 };
            let next = after(row);
            let rows = [before, row, next, after(next)].map(|row| &self.commands[row]);
            for part in 0..if is_end(row) { 1 } else { times } {
                let share = part as f64 / times as f64;
                let curve = |of: fn(&Command) -> f64| cubic(rows.map(of), share);
                time.push(self.time[row] + share * (self.time[next] - self.time[row]));
                temperature.extend(self.temperature.get(row));
                commands.push(Command {
                    effort: curve(|command| command.effort),
                    reference: curve(|command| command.reference),
                    reference_velocity: curve(|command| command.reference_velocity),
                    feed_forward: curve(|command| command.feed_forward),
                    supply: curve(|command| command.supply),
                    ..*rows[1]
                });
            }
        }
        (Self { time, commands, temperature }, places)
    }

    /// One command for so many rows.
    #[cfg(test)]
    pub(super) fn held(command: Command, period_s: f64, rows: usize) -> Self {
        let time = (0..rows).map(|row| period_s * row as f64).collect();
        Self { time, commands: vec![command; rows], temperature: Vec::new() }
    }

    /// What acts at a time, s, that lies at or after that of `row` and before the next; `row` may be moved back by a delay.
    #[must_use]
    pub fn at<T: Number>(&self, time: T, near: usize) -> Command<T> {
        let mut row = near.min(self.time.len().saturating_sub(1));
        while row > 0 && time < self.time[row] {
            row -= 1;
        }
        let command = &self.commands[row];
        let next = (row + 1).min(self.commands.len() - 1);
        let span = if next > row { self.time[next] - self.time[row] } else { f64::INFINITY };
        let share = (time - self.time[row]) / span;
        let share = if share < 0.0 {
            T::zero()
        } else if share > 1.0 {
            T::one()
        } else {
            share
        };
        let after = &self.commands[next];
        let between = |of: fn(&Command) -> f64| share * (of(after) - of(command)) + of(command);
        Command {
            effort: between(|command| command.effort),
            reference: between(|command| command.reference),
            reference_velocity: between(|command| command.reference_velocity),
            feed_forward: between(|command| command.feed_forward),
            supply: between(|command| command.supply),
            kp: command.kp.map(T::from),
            is_voltage: command.is_voltage,
            enabled: command.enabled,
        }
    }
}

/// The curve through the middle two of four values at a share of the way between them, its slope at each that of the line through its neighbours.
fn cubic([before, from, to, after]: [f64; 4], share: f64) -> f64 {
    let (leaving, arriving) = (0.5 * (to - before), 0.5 * (after - from));
    let way = to - from;
    from + share * (leaving + share * (3.0 * way - 2.0 * leaving - arriving + share * (leaving + arriving - 2.0 * way)))
}

/// A reference that moves no faster than the firmware lets it.
fn rate_limited(time: &[f64], reference: &[f64], actuator: &Actuator) -> Vec<f64> {
    let mut limited = RateLimited::new(actuator.velocity_limit);
    let mut before = time.first().copied().unwrap_or(0.0);
    let follow = |(now, wanted): (&f64, &f64)| limited.follow(*wanted, now - std::mem::replace(&mut before, *now));
    time.iter().zip(reference).map(follow).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_goes_through_the_rows_and_along_a_parabola_between_them() {
        let parabola = |time: f64| 0.3 + time - 2.0 * time * time;
        let mut series = Series::held(Command { enabled: true, ..Command::default() }, 0.1, 6);
        for row in 0..6 {
            series.commands[row].reference = parabola(series.time[row]);
        }
        let (curve, places) = series.on_a_curve(4, &[0]);
        assert_eq!(places, [0, 4, 8, 12, 16, 20]);
        let (broken, places) = series.on_a_curve(4, &[0, 3]);
        assert_eq!((broken.time.len(), places), (18, vec![0, 4, 8, 9, 13, 17]));
        assert_eq!(broken.commands[9], series.commands[3]);
        assert_eq!(curve.time.len(), 21);
        for row in 0..6 {
            assert_eq!((curve.time[4 * row], curve.commands[4 * row]), (series.time[row], series.commands[row]));
        }
        for row in 4..16 {
            assert!((curve.commands[row].reference - parabola(curve.time[row])).abs() < 1e-12);
        }
        assert!(curve.commands[7].enabled);
    }
}
