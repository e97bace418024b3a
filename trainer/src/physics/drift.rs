//! B4, Bittencourt 2014: friction drifts slowly with time and does not recover at rest.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};

pub(super) struct SlowDrift;

impl Hypothesis for SlowDrift {
    fn id(&self) -> EffectId {
        EffectId::SlowDrift
    }

    fn equation(&self) -> &'static str {
        "dF = (kappa (t - t_0) [+ kappa_2 (t - t_0)^2]) tanh(v/v_eps)"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        if state.duration() < 10.0 { Vec::new() } else { vec![vec![0.0], vec![1.0]] }
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let start = state.time.first().copied().unwrap_or(0.0);
        let age = |i: usize| state.time[i] - start;
        let mut columns = vec![state.map(|i| age(i) * state.sign[i])];
        if shape[0] == 1.0 {
            columns.push(state.map(|i| age(i) * age(i) * state.sign[i]));
        }
        columns
    }

    fn coefficients(&self, shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        let rate = ("drift_rate", "kappa", Dimension::TorquePerSecond);
        let bend = ("drift_bend", "kappa_2", Dimension::TorquePerSecondSquared);
        if shape[0] == 1.0 { vec![rate, bend] } else { vec![rate] }
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![ShapeName::new("variant", "variant", Dimension::One)]
    }
}
