//! F3, Kulldorff 1997: a one-off event, found by scanning windows in time.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};

pub(super) struct TransientEvent;

/// Lengths of the scanned windows in s.
const WINDOWS_S: [f64; 4] = [0.12, 0.35, 1.0, 3.0];

impl Hypothesis for TransientEvent {
    fn id(&self) -> EffectId {
        EffectId::TransientEvent
    }

    fn equation(&self) -> &'static str {
        "dF = A while t_1 <= t < t_2"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let (Some(&begin), Some(&end)) = (state.time.first(), state.time.last()) else { return Vec::new() };
        let mut shapes = Vec::new();
        for window in WINDOWS_S {
            // At most eighty windows of a length: a long recording is scanned with longer steps, the ends are refined.
            let step = (0.6 * window).max((end - begin) / 80.0);
            let windows = ((end - begin - window) / step).floor().max(0.0) as usize;
            shapes.extend((0..=windows).map(|k| begin + k as f64 * step).map(|start| vec![start, start + window]));
        }
        shapes
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

    fn bounds(&self, state: &JointState, _index: usize) -> Option<(f64, f64)> {
        Some((*state.time.first()?, *state.time.last()?))
    }

    fn step(&self, _state: &JointState, _index: usize, shape: &[f64]) -> f64 {
        0.3 * (shape[1] - shape[0]).abs()
    }
}
