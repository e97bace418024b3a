//! F3, Kulldorff 1997: a one-off event, found by scanning windows in time. The windows are proposed by the residual itself,
//! so their score pays for all that were looked at.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};

pub(super) struct TransientEvent;

/// Lengths of the scanned windows in s.
const WINDOWS_S: [f64; 4] = [0.12, 0.35, 1.0, 3.0];

/// Windows of a length that are proposed.
const PROPOSED: usize = 6;

/// Of all windows at half-window steps, those in which the residual of the base deviates most on one side. Samples slower
/// than `slow` do not count: near standstill the residual is that of stiction.
fn most_deviating(state: &JointState, window: f64, slow: f64) -> Vec<Shape> {
    let rest: Vec<f64> = state.torque.iter().zip(&state.predicted).map(|(t, p)| t - p).collect();
    let moving: Vec<bool> = state.velocity.iter().map(|v| v.abs() > slow).collect();
    let count = moving.iter().filter(|m| **m).count().max(1) as f64;
    let mean = rest.iter().zip(&moving).filter(|(_, m)| **m).map(|(r, _)| r).sum::<f64>() / count;
    let length = ((window / state.period) as usize).max(2);
    let mut windows: Vec<(f64, usize, usize)> = Vec::new();
    for segment in &state.segments {
        let mut begin = segment.start;
        while begin < segment.end {
            let end = (begin + length).min(segment.end);
            let sum: f64 = (begin..end).filter(|&i| moving[i]).map(|i| rest[i] - mean).sum();
            let moved = (begin..end).filter(|&i| moving[i]).count().max(1) as f64;
            windows.push((sum * sum / moved, begin, end));
            begin += (length / 2).max(1);
        }
    }
    windows.sort_by(|a, b| b.0.total_cmp(&a.0));
    windows
        .iter()
        .take(PROPOSED)
        .map(|(_, begin, end)| vec![state.time[*begin], state.time[end - 1] + state.period])
        .collect()
}

impl Hypothesis for TransientEvent {
    fn id(&self) -> EffectId {
        EffectId::TransientEvent
    }

    fn equation(&self) -> &'static str {
        "dF = A while t_1 <= t < t_2"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let speeds = [0.03 * state.top_speed(), 2.0 * state.sign_velocity];
        WINDOWS_S
            .into_iter()
            .flat_map(|window| speeds.into_iter().flat_map(move |slow| most_deviating(state, window, slow)))
            .collect()
    }

    fn scanned(&self, state: &JointState) -> Option<f64> {
        Some(WINDOWS_S.into_iter().map(|window| state.duration() / (0.5 * window)).sum())
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        vec![state.map(|i| f64::from(state.time[i] >= shape[0] && state.time[i] < shape[1]))]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("event_torque", "A", Dimension::Torque)]
    }

    fn shape_names(&self) -> Vec<ShapeName> {
        vec![
            ShapeName::new("event_start", "t_1", Dimension::Second),
            ShapeName::new("event_end", "t_2", Dimension::Second),
        ]
    }

    fn bounds(&self, state: &JointState, _index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        Some((*state.time.first()?, *state.time.last()?))
    }

    fn step(&self, _state: &JointState, _index: usize, shape: &[f64]) -> f64 {
        0.3 * (shape[1] - shape[0]).abs()
    }
}
