//! How well a prediction agrees: on all rows, after a low-pass, and on moving rows and rows at rest apart.

use super::agreement::Agreement;
use super::model::HostModel;
use super::outcome::{RestScore, Score, SplitScore, Trace};
use super::predict::{EveryRowPredicted, Prediction, nothing_recorded, predict_every_row};
use crate::error::{Error, Result};
use crate::numerics::between_samples::between_samples;
use crate::numerics::filter::gaussian::{GaussianFilter, Order};
use crate::recording::{Quantity, Recording};
use crate::samples::top_speed;
use frikan_shared::model::SLOW_SHARE;
use std::ops::Range;

/// Rate at which recordings are compared after a low-pass, Hz: that of the published figures of robot and linear axes.
const COMPARISON_RATE_HZ: f64 = 100.0;
/// Standard deviation of the low-pass before it, s: 10 dB down at half that rate.
const COMPARISON_SIGMA_S: f64 = 0.2415 / (0.5 * COMPARISON_RATE_HZ);

/// Below this share of the top speed a row is at rest: friction is any value within break-away there.
const REST_SHARE: f64 = 0.01;

/// Most rows that a trace holds: more than any picture shows. Chosen with what is kept of a row, 48 B, in mind.
const MOST_TRACED_ROWS: usize = 1 << 20;

/// What a model makes of a recording, and how well it agrees.
///
/// # Errors
/// As [`predict`](super::predict::predict) and [`every_row`](super::predict::every_row); `FRK-D009` when the recording has neither actuator nor
/// friction.
pub fn trace(model: &HostModel, recording: &Recording) -> Result<Trace> {
    trace_delayed(model, recording, 0.0)
}

/// The same of a recording whose torque is late by `torque_delay_s` (negative where early), and the prediction with it.
///
/// # Errors
/// As [`trace`].
pub(super) fn trace_delayed(model: &HostModel, recording: &Recording, torque_delay_s: f64) -> Result<Trace> {
    let in_file = |error: Error| error.in_file(recording.file());
    let rows = predict_every_row(model, recording).map_err(in_file)?.delayed(torque_delay_s);
    let measured = measured(recording).ok_or_else(|| in_file(nothing_recorded()))?;
    let Prediction { friction, rigid_body } = &rows.prediction;
    let predicted = |row: usize| friction[row] + rigid_body[row];
    let (slow_measured, slow_predicted) = (rows.low_passed(|row| measured[row]), rows.low_passed(predicted));
    let velocity = Some(&rows.velocity[..]).filter(|velocity| !velocity.is_empty());
    let (agreement, split) =
        (Agreement::of(0..measured.len(), |row| measured[row], predicted), Split::of(&rows, measured));
    let stride = measured.len().div_ceil(MOST_TRACED_ROWS).max(1);
    let traced = |value: &dyn Fn(usize) -> f64| (0..measured.len()).step_by(stride).map(value).collect::<Vec<f64>>();
    let time = recording.values(Quantity::Time);
    Ok(Trace {
        label: recording.label.clone(),
        stride,
        time: traced(&|row| time.map_or(row as f64, |time| time[row])),
        velocity: velocity.map(|velocity| traced(&|row| velocity[row])).unwrap_or_default(),
        score: agreement.score(),
        split: split.score(),
        filtered_score: Score::of(&slow_measured, &slow_predicted),
        friction: traced(&|row| measured[row] - rigid_body[row]),
        predicted_friction: traced(&|row| friction[row]),
        measured: traced(&|row| measured[row]),
        predicted: traced(&predicted),
        agreement,
        moving: split.moving,
    })
}

/// What a model leaves of the actuator at every row of a recording.
///
/// # Errors
/// As [`trace`].
pub fn residual(model: &HostModel, recording: &Recording) -> Result<Vec<f64>> {
    let in_file = |error: Error| error.in_file(recording.file());
    let Prediction { friction, rigid_body } = predict_every_row(model, recording).map_err(in_file)?.prediction;
    let measured = measured(recording).ok_or_else(|| in_file(nothing_recorded()))?;
    let predicted = friction.iter().zip(&rigid_body).map(|(friction, body)| friction + body);
    Ok(measured.iter().zip(predicted).map(|(measured, predicted)| measured - predicted).collect())
}

/// What a prediction is scored on: friction that was separated, or else the actuator.
fn measured(recording: &Recording) -> Option<&[f64]> {
    recording.separated_friction().or_else(|| recording.actuator()).map(|channel| channel.values.as_slice())
}

impl EveryRowPredicted {
    /// The prediction as it is recorded with a delay, s.
    fn delayed(mut self, delay_s: f64) -> Self {
        let samples = self.rate_hz.map_or(0.0, |rate| rate * delay_s);
        if samples == 0.0 {
            return self;
        }
        for series in [&mut self.prediction.friction, &mut self.prediction.rigid_body] {
            for segment in &self.segments {
                let segment = &mut series[segment.clone()];
                let late: Vec<f64> = (0..segment.len()).map(|i| between_samples(segment, i as f64 - samples)).collect();
                segment.copy_from_slice(&late);
            }
        }
        self
    }

    /// A value a row after a zero-phase low-pass, at the rate of comparison and without the ends that the filter does not reach; as it is where
    /// the recording is not faster.
    fn low_passed(&self, value: impl Fn(usize) -> f64) -> Vec<f64> {
        let Some(rate_hz) = self.rate_hz.filter(|rate| *rate > COMPARISON_RATE_HZ) else {
            return (0..self.prediction.friction.len()).map(value).collect();
        };
        let filter = GaussianFilter::new(COMPARISON_SIGMA_S, 1.0 / rate_hz);
        let stride = (rate_hz / COMPARISON_RATE_HZ).round().max(1.0) as usize;
        let segment = |range: &Range<usize>| {
            filter.apply(&range.clone().map(&value).collect::<Vec<f64>>(), Order::Smooth, stride)
        };
        let long_enough = self.segments.iter().filter(|segment| segment.len() > 2 * filter.half_width());
        long_enough.flat_map(segment).collect()
    }
}

impl Agreement {
    fn score(&self) -> Score {
        let share = |of: f64| if of > 0.0 { self.residual / of } else { 0.0 };
        Score {
            n: self.n,
            r2: 1.0 - share(self.spread),
            rmse: (self.residual / self.n.max(1) as f64).sqrt(),
            relative_error: share(self.power).sqrt(),
        }
    }
}

impl Score {
    /// Agreement of a prediction with a measurement of the same length.
    #[must_use]
    pub fn of(measured: &[f64], predicted: &[f64]) -> Self {
        Agreement::of(0..measured.len(), |row| measured[row], |row| predicted[row]).score()
    }

    /// Agreement over several recordings taken as one.
    #[must_use]
    pub fn over(traces: &[Trace]) -> Self {
        traces.iter().fold(Agreement::default(), |all, trace| all.with(&trace.agreement)).score()
    }
}

/// Moving rows, and rows at rest.
struct Split {
    moving: Agreement,
    rest: RestScore,
}

impl Split {
    /// Agreement on moving rows, and the share of rows at rest whose torque, less the rigid body, lies within the largest
    /// friction that the law has at low speed, give or take the error on moving rows. Without a velocity every row moves.
    fn of(rows: &EveryRowPredicted, measured: &[f64]) -> Self {
        let Prediction { friction, rigid_body } = &rows.prediction;
        let speed = |row: usize| rows.velocity.get(row).map_or(f64::INFINITY, |velocity| velocity.abs());
        let top = top_speed(&rows.velocity);
        let moves = |row: &usize| speed(*row) > REST_SHARE * top;
        let all = 0..measured.len();
        let predicted = |row: usize| friction[row] + rigid_body[row];
        let moving = Agreement::of(all.clone().filter(moves), |row| measured[row], predicted);
        let slow = all.clone().filter(|row| speed(*row) <= SLOW_SHARE * top);
        let breakaway = slow.fold(0.0_f64, |most, row| most.max(friction[row].abs())) + moving.score().rmse;
        let rest = || all.clone().filter(|row| !moves(row));
        let n = rest().count();
        let inside = rest().filter(|row| (measured[*row] - rigid_body[*row]).abs() <= breakaway).count();
        let share = if n == 0 { 1.0 } else { inside as f64 / n as f64 };
        Self { moving, rest: RestScore { n, inside_breakaway: share } }
    }

    fn score(&self) -> SplitScore {
        SplitScore { moving: self.moving.score(), rest: self.rest }
    }
}

impl SplitScore {
    /// Agreement over several recordings taken as one.
    #[must_use]
    pub fn over(traces: &[Trace]) -> Self {
        let moving = traces.iter().fold(Agreement::default(), |all, trace| all.with(&trace.moving));
        let n = traces.iter().map(|trace| trace.split.rest.n).sum();
        let rows = |trace: &Trace| trace.split.rest.n as f64;
        let inside: f64 = traces.iter().map(|trace| rows(trace) * trace.split.rest.inside_breakaway).sum();
        let share = if n == 0 { 1.0 } else { inside / n as f64 };
        Self { moving: moving.score(), rest: RestScore { n, inside_breakaway: share } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_at_rest_count_by_whether_friction_can_hold_them() {
        let velocity: Vec<f64> =
            (0..200).map(|i| if i < 100 { 0.0 } else { 0.05 + f64::from(i - 100) * 0.01 }).collect();
        let friction: Vec<f64> = velocity.iter().map(|v| if *v > 0.0 { 2.0 } else { 0.0 }).collect();
        let prediction = Prediction { friction: friction.clone(), rigid_body: vec![1.0; 200] };
        let rows = EveryRowPredicted { prediction, velocity, ..EveryRowPredicted::default() };
        // At rest anything up to break-away is right, and a quarter of the rows is beyond.
        let measured: Vec<f64> = (0..200)
            .map(|i| {
                if i < 25 {
                    4.0
                } else if i < 100 {
                    1.0 - 1.9
                } else {
                    3.0 + 1e-9
                }
            })
            .collect();
        let found = Split::of(&rows, &measured).score();
        assert_eq!((found.moving.n, found.rest.n), (100, 100));
        assert!(found.moving.rmse < 1e-6 && (found.rest.inside_breakaway - 0.75).abs() < 1e-12, "{found:?}");
    }
}
