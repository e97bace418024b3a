//! How well a prediction agrees: on all rows, after a low-pass, and on moving rows and rows at rest apart.

use super::model::HostModel;
use super::outcome::{RestScore, Score, SplitScore, Trace};
use super::predict::{Prediction, every_row, nothing_recorded, predict};
use crate::error::{Error, Result};
use crate::numerics::between_samples::between_samples;
use crate::numerics::filter::gaussian::{GaussianFilter, Order};
use crate::recording::Recording;
use crate::samples::{Samples, top_speed};
use frikan_shared::model::SLOW_SHARE;
use std::ops::Range;

/// Rate at which recordings are compared after a low-pass, Hz: that of the published figures of robot and linear axes.
const COMPARISON_RATE_HZ: f64 = 100.0;
/// Standard deviation of the low-pass before it, s: 10 dB down at half that rate.
const COMPARISON_SIGMA_S: f64 = 0.2415 / (0.5 * COMPARISON_RATE_HZ);

/// Below this share of the top speed a row is at rest: friction is any value within break-away there.
const REST_SHARE: f64 = 0.01;

/// What a model makes of a recording, and how well it agrees.
///
/// # Errors
/// As [`predict`] and [`every_row`]; `FRK-D009` when the recording has neither actuator nor friction.
pub fn trace(model: &HostModel, recording: &Recording) -> Result<Trace> {
    trace_delayed(model, recording, 0.0)
}

/// The same of a recording whose torque is late by `torque_delay_s` (negative where early), and the prediction with it.
///
/// # Errors
/// As [`trace`].
pub(super) fn trace_delayed(model: &HostModel, recording: &Recording, torque_delay_s: f64) -> Result<Trace> {
    let in_file = |error: Error| error.in_file(recording.file());
    let rows = every_row(model, recording).map_err(in_file)?;
    let prediction = delayed(predict(model, &rows).map_err(in_file)?, &rows, torque_delay_s);
    let measured = rows.recorded.clone().ok_or_else(|| in_file(nothing_recorded()))?;
    let predicted = prediction.total();
    let (slow_measured, slow_predicted) = (low_passed(&rows, &measured), low_passed(&rows, &predicted));
    let time = if rows.time.is_empty() { (0..rows.len()).map(|row| row as f64).collect() } else { rows.time.clone() };
    Ok(Trace {
        label: recording.label.clone(),
        time,
        velocity: rows.velocity.clone().unwrap_or_default(),
        score: Score::of(&measured, &predicted),
        split: SplitScore::of(rows.velocity.as_deref(), &measured, &prediction),
        filtered_score: Score::of(&slow_measured, &slow_predicted),
        friction: measured.iter().zip(&prediction.rigid_body).map(|(total, body)| total - body).collect(),
        predicted_friction: prediction.friction,
        measured,
        predicted,
    })
}

/// A prediction as it is recorded with a delay.
fn delayed(prediction: Prediction, rows: &Samples, delay_s: f64) -> Prediction {
    let samples = rows.rate_hz.map_or(0.0, |rate| rate * delay_s);
    if samples == 0.0 {
        return prediction;
    }
    let late = |series: Vec<f64>| -> Vec<f64> {
        let segment = |segment: &Range<usize>| {
            let series = &series[segment.clone()];
            (0..series.len()).map(|i| between_samples(series, i as f64 - samples)).collect::<Vec<f64>>()
        };
        rows.segments.iter().flat_map(segment).collect()
    };
    Prediction { friction: late(prediction.friction), rigid_body: late(prediction.rigid_body) }
}

/// A column of a recording's rows after a zero-phase low-pass, at the rate of comparison and without the ends that the
/// filter does not reach; as it is where the recording is not faster.
fn low_passed(rows: &Samples, column: &[f64]) -> Vec<f64> {
    let Some(rate_hz) = rows.rate_hz.filter(|rate| *rate > COMPARISON_RATE_HZ) else { return column.to_vec() };
    let filter = GaussianFilter::new(COMPARISON_SIGMA_S, 1.0 / rate_hz);
    let stride = (rate_hz / COMPARISON_RATE_HZ).round().max(1.0) as usize;
    let segment = |range: &Range<usize>| filter.apply(&column[range.clone()], Order::Smooth, stride);
    let long_enough = rows.segments.iter().filter(|segment| segment.len() > 2 * filter.half_width());
    long_enough.flat_map(segment).collect()
}

impl Score {
    /// Agreement of a prediction with a measurement of the same length.
    #[must_use]
    pub fn of(measured: &[f64], predicted: &[f64]) -> Self {
        let n = measured.len();
        let count = n.max(1) as f64;
        let mean = measured.iter().sum::<f64>() / count;
        let residual: f64 = measured.iter().zip(predicted).map(|(m, p)| (m - p).powi(2)).sum();
        let spread: f64 = measured.iter().map(|m| (m - mean).powi(2)).sum();
        let power: f64 = measured.iter().map(|m| m * m).sum();
        let share = |of: f64| if of > 0.0 { residual / of } else { 0.0 };
        Self { n, r2: 1.0 - share(spread), rmse: (residual / count).sqrt(), relative_error: share(power).sqrt() }
    }

    /// Agreement over several recordings taken as one.
    #[must_use]
    pub fn over(traces: &[Trace]) -> Self {
        let join =
            |pick: fn(&Trace) -> &Vec<f64>| traces.iter().flat_map(|t| pick(t).iter().copied()).collect::<Vec<_>>();
        Self::of(&join(|trace| &trace.measured), &join(|trace| &trace.predicted))
    }
}

impl SplitScore {
    /// Agreement on moving rows, and the share of rows at rest whose torque, less the rigid body, lies within the largest
    /// friction that the law has at low speed, give or take the error on moving rows. Without a velocity every row moves.
    #[must_use]
    pub fn of(velocity: Option<&[f64]>, measured: &[f64], prediction: &Prediction) -> Self {
        let speed = |row: usize| velocity.map_or(f64::INFINITY, |velocity| velocity[row].abs());
        let top = velocity.map_or(0.0, top_speed);
        let (moving, rest): (Vec<usize>, Vec<usize>) =
            (0..measured.len()).partition(|&row| speed(row) > REST_SHARE * top);
        let total = prediction.total();
        let pick = |column: &[f64]| moving.iter().map(|&row| column[row]).collect::<Vec<f64>>();
        let moving_score = Score::of(&pick(measured), &pick(&total));
        let slow = prediction.friction.iter().enumerate().filter(|(row, _)| speed(*row) <= SLOW_SHARE * top);
        let breakaway = slow.fold(0.0_f64, |most, (_, friction)| most.max(friction.abs())) + moving_score.rmse;
        let is_inside = |row: &&usize| (measured[**row] - prediction.rigid_body[**row]).abs() <= breakaway;
        let inside = rest.iter().filter(is_inside).count();
        let share = if rest.is_empty() { 1.0 } else { inside as f64 / rest.len() as f64 };
        Self { moving: moving_score, rest: RestScore { n: rest.len(), inside_breakaway: share } }
    }

    /// Agreement over several recordings taken as one.
    #[must_use]
    pub fn over(traces: &[Trace]) -> Self {
        let rows = |trace: &Trace| trace.split.rest.n as f64;
        let (mut measured, mut predicted) = (Vec::new(), Vec::new());
        let n = traces.iter().map(|trace| trace.split.rest.n).sum();
        let inside: f64 = traces.iter().map(|trace| rows(trace) * trace.split.rest.inside_breakaway).sum();
        for trace in traces {
            let top = top_speed(&trace.velocity);
            let moves = |row: &usize| trace.velocity.get(*row).is_none_or(|v| v.abs() > REST_SHARE * top);
            for row in (0..trace.measured.len()).filter(moves) {
                measured.push(trace.measured[row]);
                predicted.push(trace.predicted[row]);
            }
        }
        let share = if n == 0 { 1.0 } else { inside / n as f64 };
        Self { moving: Score::of(&measured, &predicted), rest: RestScore { n, inside_breakaway: share } }
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
        let found = SplitScore::of(Some(&velocity), &measured, &prediction);
        assert_eq!((found.moving.n, found.rest.n), (100, 100));
        assert!(found.moving.rmse < 1e-6 && (found.rest.inside_breakaway - 0.75).abs() < 1e-12, "{found:?}");
    }
}
