//! Whether recordings are of one joint with one load, and a simulation of a joint at all.

use crate::diagnose::measurement::signals::Signals;
use crate::error::{Error, Result, codes};
use crate::figures::digits;
use crate::numerics::jackknife::Jackknife;
use crate::numerics::statistics::root_mean_square;
use crate::physics::units::Units;
use crate::recording::{Quantity, Recording};
use crate::workflow::recordings::units;

/// Torque or speed of a simulation over that of the recording from which it has diverged: where a simulator computes at all, errors of its
/// model are of the size of what it computes.
const DIVERGED_RATIO: f64 = 100.0;

/// Least difference of two rigid bodies of one joint and load, as a share of the larger: recordings determine them far better, and no
/// friction passes for so much of them.
const OTHER_BODY_SHARE: f64 = 0.5;
/// The same in standard errors.
const OTHER_BODY_DEVIATIONS: f64 = 5.0;
/// Share of the torque that a part of the rigid body has to have in both recordings to be compared: the noise of the acceleration hides less.
const LEAST_TORQUE_SHARE: f64 = 0.2;

/// Refuses a simulation that has diverged.
///
/// # Errors
/// `FRK-D045`.
pub(super) fn refuse_diverged(real: &Recording, simulated: &Recording) -> Result<()> {
    let actuator = |recording: &Recording| recording.actuator().map_or(0.0, |channel| largest(&channel.values));
    let Units { actuator: unit, rotary } = units(real);
    let velocity = if rotary { "rad/s" } else { "m/s" };
    let compared = [(unit, actuator(real), actuator(simulated)), (velocity, fastest(real), fastest(simulated))];
    for (unit, recorded, computed) in compared {
        if recorded > 0.0 && computed > DIVERGED_RATIO * recorded {
            let message = format!(
                "the simulation reaches {} {unit}, the recording {} {unit}: it has diverged, or is in another unit",
                digits(computed),
                digits(recorded)
            );
            return Err(Error::new(&codes::SIMULATION_DIVERGED, message).in_file(simulated.file()));
        }
    }
    Ok(())
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| if value.is_nan() { f64::INFINITY } else { most.max(value.abs()) })
}

/// Largest speed from row to row.
fn fastest(recording: &Recording) -> f64 {
    let Some([time, position]) = [Quantity::Time, Quantity::Position]
        .map(|quantity| recording.channel(quantity).map(|channel| &channel.values))
        .into_iter()
        .collect::<Option<Vec<_>>>()
        .and_then(|pair| <[_; 2]>::try_from(pair).ok())
    else {
        return 0.0;
    };
    let steps = time.windows(2).zip(position.windows(2)).filter(|(time, _)| time[1] > time[0]);
    largest(&steps.map(|(time, position)| (position[1] - position[0]) / (time[1] - time[0])).collect::<Vec<_>>())
}

/// Refuses a recording whose rigid body is that of another joint or load than the first one's.
///
/// # Errors
/// `FRK-D018`.
pub(super) fn refuse_other_joint(first: &Signals, next: &Signals, files: [&Recording; 2]) -> Result<()> {
    if first.rigid_body.is_some() || next.rigid_body.is_some() {
        return Ok(());
    }
    let (Some(one), Some(other)) = (Body::of(first), Body::of(next)) else { return Ok(()) };
    let parts = [("inertia", one.inertia, other.inertia), ("gravity torque", one.gravity, other.gravity)];
    for (name, one, other) in parts {
        if one.is_other_than(&other) {
            let message = format!(
                "here the {name} is {}, in {} it is {}: these are not of one joint with one load; diagnose each by itself",
                digits(other.size()),
                files[0].file(),
                digits(one.size())
            );
            return Err(Error::new(&codes::RECORDINGS_DISAGREE, message).in_file(files[1].file()));
        }
    }
    Ok(())
}

/// A part of a rigid body: coefficients of one or two columns.
#[derive(Clone, Copy, Debug, Default)]
struct Part {
    value: [f64; 2],
    /// Standard error of its size.
    error: f64,
    /// Share of the torque.
    share: f64,
}

impl Part {
    fn size(&self) -> f64 {
        self.value[0].hypot(self.value[1])
    }

    fn is_other_than(&self, other: &Self) -> bool {
        let apart = (self.value[0] - other.value[0]).hypot(self.value[1] - other.value[1]);
        self.share.min(other.share) > LEAST_TORQUE_SHARE
            && apart > OTHER_BODY_SHARE * self.size().max(other.size())
            && apart > OTHER_BODY_DEVIATIONS * self.error.hypot(other.error)
    }
}

/// What a recording says of inertia and gravity beside Coulomb and viscous friction.
#[derive(Clone, Copy, Debug)]
struct Body {
    inertia: Part,
    gravity: Part,
}

impl Body {
    fn of(signals: &Signals) -> Option<Self> {
        let state = signals.states();
        let of_position = |of: fn(f64) -> f64| state.position.iter().map(|q| of(*q)).collect::<Vec<f64>>();
        let count = signals.torque.len();
        let mut columns =
            vec![state.acceleration.clone(), state.velocity.clone(), state.sign.clone(), vec![1.0; count]];
        if signals.rotary {
            columns.extend([of_position(f64::sin), of_position(f64::cos)]);
        }
        let jackknife = Jackknife::new(&columns, &signals.torque);
        let whole = jackknife.of(std::slice::from_ref(&(0..count)))?;
        let errors = jackknife.errors();
        let torque = root_mean_square(&signals.torque);
        let part = |places: &[usize]| {
            let mut part = Part::default();
            let mut moved = vec![0.0; count];
            for (value, place) in part.value.iter_mut().zip(places) {
                *value = whole[*place];
                moved.iter_mut().zip(&columns[*place]).for_each(|(moved, column)| *moved += *value * column);
            }
            let variance = |place: &usize| errors.iter().map(|error| error[*place].powi(2)).sum::<f64>();
            part.error = places.iter().map(variance).sum::<f64>().sqrt();
            // What does not change with the motion is an offset as well as gravity.
            let mean = moved.iter().sum::<f64>() / count as f64;
            moved.iter_mut().for_each(|moved| *moved -= mean);
            part.share = root_mean_square(&moved) / torque;
            part
        };
        let gravity = if signals.rotary { part(&[4, 5]) } else { Part::default() };
        Some(Self { inertia: part(&[0]), gravity })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::parse;
    use std::fmt::Write;

    /// Twenty seconds of a joint of an inertia and a gravity torque, with Coulomb friction of a level.
    fn recording(inertia: f64, gravity: f64, coulomb: f64, scale: f64) -> Recording {
        let mut text = String::from("time_s,position_rad,torque_Nm\n");
        for row in 0..4000 {
            let t = 0.005 * f64::from(row);
            let [a, b] = [2.1, 5.3];
            let q = (a * t).sin() + 0.3 * (b * t).sin();
            let v = a * (a * t).cos() + 0.3 * b * (b * t).cos();
            let acceleration = -a * a * (a * t).sin() - 0.3 * b * b * (b * t).sin();
            let noise = 0.03 * (91.0 * t).sin();
            let torque = inertia * acceleration + gravity * q.sin() + coulomb * (v / 0.01).tanh() + 0.4 * v + noise;
            writeln!(text, "{t},{q},{}", scale * torque).unwrap();
        }
        parse("recording.csv", text.as_bytes(), &Default::default()).unwrap()
    }

    fn compared(one: &Recording, other: &Recording) -> Result<()> {
        let signals = [one, other].map(|recording| Signals::of(recording, &Default::default()).unwrap());
        refuse_other_joint(&signals[0], &signals[1], [one, other])
    }

    #[test]
    fn recordings_of_different_joints_are_told_from_friction_that_drifts() {
        let first = recording(0.5, 3.0, 1.0, 1.0);
        assert!(compared(&first, &recording(0.5, 3.0, 1.98, 1.0)).is_ok(), "friction drifts");
        let error = compared(&first, &recording(0.08, 0.6, 0.2, 1.0)).unwrap_err();
        assert!(error.code().id == "FRK-D018" && error.message().contains("inertia"), "{error}");
        let error = compared(&first, &recording(0.5, 9.0, 1.0, 1.0)).unwrap_err();
        assert!(error.message().contains("gravity torque"), "{error}");
    }

    #[test]
    fn a_simulation_that_diverged_is_refused() {
        let real = recording(0.5, 3.0, 1.0, 1.0);
        assert!(refuse_diverged(&real, &recording(0.3, 2.0, 0.4, 1.0)).is_ok());
        let error = refuse_diverged(&real, &recording(0.3, 2.0, 0.4, 1e6)).unwrap_err();
        assert!(error.code().id == "FRK-D045" && error.message().contains("diverged"), "{error}");
    }
}
