//! F1: the actuator gives less than commanded beyond a torque limit. The regressor is the torque that the model needs, not
//! the recorded one, whose noise would explain itself.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName, geometric_grid};
use crate::statistics::quantile;

pub(super) struct Saturation;

/// Lowest and highest limit worth testing: near the largest torques, since a limit far below would be a wrong scale.
fn levels(state: &JointState) -> (f64, f64) {
    let at = |share| quantile(state.predicted.iter().map(|t| t.abs()), share);
    (at(0.7).max(0.45 * at(0.998)), at(0.995))
}

impl Hypothesis for Saturation {
    fn id(&self) -> EffectId {
        EffectId::Saturation
    }

    fn equation(&self) -> &'static str {
        "dF = c sign(tau) max(0, |tau| - tau_max), tau = torque needed"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let (low, high) = levels(state);
        if high <= low {
            Vec::new()
        } else {
            geometric_grid(low, high, 6).into_iter().map(|level| vec![level]).collect()
        }
    }

    fn only_positive(&self) -> bool {
        true
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        vec![state.map(|i| (state.predicted[i].abs() - shape[0]).max(0.0) * state.predicted[i].signum())]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("excess_command", "c", Dimension::One)]
    }

    fn shape_names(&self) -> Vec<ShapeName> {
        vec![ShapeName::new("torque_limit", "tau_max", Dimension::Torque)]
    }

    fn bounds(&self, state: &JointState, _index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        Some(levels(state))
    }
}
