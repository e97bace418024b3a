//! C2, Hess and Soom 1990: friction follows a lagged velocity.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName, geometric_grid};

pub(super) struct FrictionalLag;

/// Velocity behind a first-order lag, restarted at each segment; exact for a velocity held over the period.
pub(crate) fn lagged_velocity(state: &JointState, lag: f64) -> Vec<f64> {
    let step = 1.0 - (-state.period / lag).exp();
    let mut lagged = vec![0.0; state.len()];
    for segment in &state.segments {
        let mut v = state.velocity[segment.start];
        for i in segment.clone() {
            v += step * (state.velocity[i] - v);
            lagged[i] = v;
        }
    }
    lagged
}

impl Hypothesis for FrictionalLag {
    fn id(&self) -> EffectId {
        EffectId::FrictionalLag
    }

    fn equation(&self) -> &'static str {
        "dF = lambda (f(v_L) - f(v)), tau_L dv_L/dt = v - v_L"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let low = (2.0 * state.period).max(2e-3);
        geometric_grid(low, 0.1f64.max(2.0 * low), 6).into_iter().map(|lag| vec![lag]).collect()
    }

    fn only_positive(&self) -> bool {
        true
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let lagged = lagged_velocity(state, shape[0]);
        vec![state.map(|i| state.base_friction_at(lagged[i]) - state.base_friction_at(state.velocity[i]))]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("lagged_share", "lambda", Dimension::One)]
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![ShapeName::new("friction_lag", "tau_L", Dimension::Second)]
    }

    fn bounds(&self, state: &JointState, _index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        Some((state.period, 0.3))
    }
}
