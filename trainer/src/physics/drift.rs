//! B4, Bittencourt 2014: friction drifts slowly with time and does not recover at rest.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape};

pub(super) struct SlowDrift;

impl Hypothesis for SlowDrift {
    fn id(&self) -> EffectId {
        EffectId::SlowDrift
    }

    fn equation(&self) -> &'static str {
        "dF = kappa (t - t_0) tanh(v/v_eps)"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        if state.duration() < 10.0 { Vec::new() } else { vec![vec![]] }
    }

    fn columns(&self, state: &JointState, _shape: &[f64]) -> Vec<Vec<f64>> {
        let start = state.time.first().copied().unwrap_or(0.0);
        vec![state.map(|i| (state.time[i] - start) * state.sign[i])]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("drift_rate", "kappa", Dimension::TorquePerSecond)]
    }
}
