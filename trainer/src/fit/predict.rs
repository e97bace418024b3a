//! What a model predicts of a recording, sample after sample, in the arithmetic of the drive.

use frikan_runtime::friction::{FrictionState, Measurement, rigid_body_torque};
use frikan_shared::model::{MAX_INPUTS, RigidBody};
use frikan_shared::units::{Quantity, Unit};

use super::model::HostModel;
use crate::error::{Error, Result, codes};
use crate::recording::Recording;
use crate::samples::{EveryRow, Preparation, Samples, prepare_every_row_of};
use std::ops::Range;

/// A prediction, one value a sample, in the unit of the model's output.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Prediction {
    /// Friction: law and effects.
    pub friction: Vec<f64>,
    /// Rigid body in force; zero where friction is recorded separated.
    pub rigid_body: Vec<f64>,
}

impl Prediction {
    /// The whole torque of the actuator.
    #[must_use]
    pub fn total(&self) -> Vec<f64> {
        self.friction.iter().zip(&self.rigid_body).map(|(friction, body)| friction + body).collect()
    }
}

/// Predicts samples.
///
/// # Errors
/// `FRK-D009` when the samples lack what the model reads, `FRK-D018` when their unit is not that of the model.
pub fn predict(model: &HostModel, samples: &Samples) -> Result<Prediction> {
    Predictor::new(model).go_on(samples, false)
}

/// Predicts the samples of a recording stretch by stretch.
struct Predictor<'m> {
    model: &'m HostModel,
    state: FrictionState,
    /// Time of the last sample, s.
    before: Option<f64>,
}

impl<'m> Predictor<'m> {
    fn new(model: &'m HostModel) -> Self {
        Self { model, state: FrictionState::new(), before: None }
    }

    /// Predicts the samples that come next, without an interruption in between where `joined`.
    ///
    /// # Errors
    /// As [`predict`].
    fn go_on(&mut self, samples: &Samples, joined: bool) -> Result<Prediction> {
        let model = self.model;
        let unit = match model.output_unit {
            Unit::Newton => "N",
            Unit::Ampere => "A",
            _ => "Nm",
        };
        if !samples.actuator_unit.is_empty() && samples.actuator_unit != unit {
            let message =
                format!("the model predicts in {unit}, the recording's actuator is in {}", samples.actuator_unit);
            return Err(Error::new(&codes::RECORDINGS_DISAGREE, message));
        }
        let channels = channels(model, samples)?;
        let friction = self.friction(samples, &channels, joined);
        let rigid_body = match samples.friction {
            Some(_) => vec![0.0; friction.len()],
            None => rigid_body(&model.rigid_body, samples)?,
        };
        Ok(Prediction { friction, rigid_body })
    }

    fn friction(&mut self, samples: &Samples, channels: &[&[f64]], joined: bool) -> Vec<f64> {
        let model = self.model;
        let at = |column: Option<&[f64]>, row: usize| column.map_or(0.0, |values| values[row] as f32);
        let mut friction = Vec::with_capacity(samples.len());
        for segment in &samples.segments {
            let mut before = self.before.filter(|_| joined && segment.start == 0);
            if !(joined && segment.start == 0) {
                let rest = self.before.zip(samples.time.get(segment.start)).map_or(0.0, |(end, begin)| begin - end);
                self.state = self.state.after_rest(&model.effects, rest as f32);
            }
            for row in segment.clone() {
                let mut measurement = Measurement {
                    velocity: at(samples.velocity.as_deref(), row),
                    position: at(samples.position.as_deref(), row),
                    acceleration: at(samples.acceleration.as_deref(), row),
                    ..Measurement::default()
                };
                let mut others = 0;
                for (input, column) in model.inputs.iter().zip(channels) {
                    let value = column[row] as f32;
                    match input.quantity {
                        Quantity::Velocity => measurement.velocity = value,
                        Quantity::Position => measurement.position = value,
                        Quantity::Acceleration => measurement.acceleration = value,
                        Quantity::Load => measurement.load = value,
                        Quantity::Temperature => measurement.temperature = value,
                        Quantity::Other(_) => {
                            measurement.other[others.min(MAX_INPUTS - 1)] = value;
                            others += 1;
                        }
                    }
                }
                let now = samples.time.get(row).copied();
                let step = now.zip(before).map_or(0.0, |(now, before)| now - before);
                friction.push(f64::from(self.state.step(model, &measurement, step as f32).torque));
                before = now;
            }
            self.before = before.or(self.before);
        }
        friction
    }
}

/// The columns that the model reads, in the order of its inputs.
pub(super) fn channels<'a>(model: &HostModel, samples: &'a Samples) -> Result<Vec<&'a [f64]>> {
    let column = |quantity: &Quantity| match quantity {
        Quantity::Load => samples.input("load").or(samples.rigid_body.as_deref()),
        other => samples.input(other.name()),
    };
    let missing = |quantity: &Quantity| {
        let mut message = format!("the model reads `{}`, which is not recorded", quantity.name());
        if *quantity == Quantity::Load {
            message += "; of a joint that reports no torque `[actuator]` of joint.toml tells it (docs/servos.md), and `trainer rollout` simulates the joint";
        }
        Error::new(&codes::MISSING_COLUMN, message).in_column(quantity.name())
    };
    model.inputs.iter().map(|input| column(&input.quantity).ok_or_else(|| missing(&input.quantity))).collect()
}

fn rigid_body(body: &RigidBody, samples: &Samples) -> Result<Vec<f64>> {
    let needs = |coefficient: f32, column: Option<&[f64]>, name: &str| {
        if coefficient != 0.0 && column.is_none() {
            let message = format!("the model's rigid body needs `{name}`, which is neither recorded nor derivable");
            return Err(Error::new(&codes::MISSING_COLUMN, message).in_column(name));
        }
        Ok(())
    };
    needs(body.inertia, samples.acceleration.as_deref(), "acceleration")?;
    needs(body.gravity_sin.abs() + body.gravity_cos.abs(), samples.position.as_deref(), "position")?;
    // A factor of exactly one is what a model has that was trained without a rigid body.
    needs(body.given_scale * (body.given_scale - 1.0), samples.rigid_body.as_deref(), "rigid_body_torque")?;
    let at = |column: Option<&[f64]>, row: usize| column.map_or(0.0, |values| values[row] as f32);
    let torque = |row| {
        let given = at(samples.rigid_body.as_deref(), row);
        let (position, acceleration) = (samples.position.as_deref(), samples.acceleration.as_deref());
        f64::from(rigid_body_torque(body, at(position, row), at(acceleration, row), given))
    };
    Ok((0..samples.len()).map(torque).collect())
}

/// Samples at every row of a recording, as `trainer predict` sees it. Filter and source of the velocity are those with which the
/// model leaves least of the recorded actuator; without one, those that keep the noise of the motion small.
///
/// # Errors
/// As [`Preparation::plan_prediction`] and [`prepare_every_row`](crate::samples::prepare_every_row).
pub fn every_row(model: &HostModel, recording: &Recording) -> Result<Samples> {
    prepare_every_row_of(recording, &planned(model, recording)?, &|name| reads(model, name))
}

/// How a recording is prepared for its prediction.
fn planned(model: &HostModel, recording: &Recording) -> Result<Preparation> {
    Preparation::plan_prediction(recording, &|samples: &Samples| {
        let recorded = samples.recorded.as_deref().ok_or_else(nothing_recorded)?;
        let predicted = predict(model, samples)?.total();
        Ok(recorded.iter().zip(predicted).map(|(measured, total)| measured - total).collect())
    })
}

/// Whether a model reads a named channel.
fn reads(model: &HostModel, name: &str) -> bool {
    let is_load = name == "load" || name == "load_torque";
    let is = |quantity: &Quantity| quantity.name() == name || *quantity == Quantity::Load && is_load;
    model.inputs.iter().any(|input| is(&input.quantity))
}

/// Rows that are filtered at a time: the filter's reach into the neighbours costs little beside them, and some 100 B each are no matter.
const ROWS_AT_A_TIME: usize = 1 << 17;

/// The prediction of every row of a recording with what a score needs beside it.
#[derive(Clone, Debug, Default)]
pub(super) struct EveryRowPredicted {
    pub(super) prediction: Prediction,
    /// Velocity as the model sees it; empty where there is none.
    pub(super) velocity: Vec<f64>,
    pub(super) segments: Vec<Range<usize>>,
    pub(super) rate_hz: Option<f64>,
}

/// The same as [`predict`] of [`every_row`], in the memory of what it gives.
///
/// # Errors
/// As both.
pub(super) fn predict_every_row(model: &HostModel, recording: &Recording) -> Result<EveryRowPredicted> {
    let (preparation, is_read) = (planned(model, recording)?, |name: &str| reads(model, name));
    let rows = EveryRow::of(recording, &preparation, &is_read)?;
    let mut predictor = Predictor::new(model);
    let mut all = EveryRowPredicted::default();
    let count = recording.len();
    for begin in (0..count).step_by(ROWS_AT_A_TIME) {
        let samples = rows.samples(&(begin..(begin + ROWS_AT_A_TIME).min(count)));
        let joined = begin > 0 && !rows.begins_segment(begin);
        let Prediction { friction, rigid_body } = predictor.go_on(&samples, joined)?;
        all.prediction.friction.extend(friction);
        all.prediction.rigid_body.extend(rigid_body);
        all.velocity.extend(samples.velocity.iter().flatten());
        all.rate_hz = samples.rate_hz;
        let mut segments = samples.segments.into_iter().map(|segment| begin + segment.start..begin + segment.end);
        if let Some(last) = all.segments.last_mut().filter(|_| joined) {
            last.end = segments.next().map_or(last.end, |rest| rest.end);
        }
        all.segments.extend(segments);
    }
    Ok(all)
}

pub(super) fn nothing_recorded() -> Error {
    Error::new(&codes::MISSING_COLUMN, "scoring needs the actuator's torque, force or current")
}
