//! C3, Rabinowicz 1958; Dieterich 1979: break-away grows with the logarithm of the preceding dwell.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName, geometric_grid};

pub(super) struct DwellBreakaway;

impl Hypothesis for DwellBreakaway {
    fn id(&self) -> EffectId {
        EffectId::DwellBreakaway
    }

    fn equation(&self) -> &'static str {
        "dF = k_d ln(1 + t_d/t_0) exp(-x/x_b) tanh(v/v_eps)"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let mut starts = 0;
        for i in 1..state.len() {
            starts +=
                usize::from(state.memory.dwell[i] > 0.0 && state.memory.at_rest[i - 1] && !state.memory.at_rest[i]);
        }
        if starts < 3 {
            return Vec::new();
        }
        let travel = state.span();
        geometric_grid(1e-3 * travel, 0.1 * travel, 5)
            .into_iter()
            .flat_map(|reach| [vec![reach, 0.05], vec![reach, 0.5]])
            .collect()
    }

    fn only_positive(&self) -> bool {
        true
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let memory = &state.memory;
        vec![state.map(|i| {
            if memory.dwell[i] > 0.0 {
                (memory.dwell[i] / shape[1]).ln_1p() * (-memory.since_start[i] / shape[0]).exp() * state.sign[i]
            } else {
                0.0
            }
        })]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("dwell_strengthening", "k_d", Dimension::Torque)]
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![
            ShapeName::new("breakaway_reach", "x_b", Dimension::Position),
            ShapeName::new("dwell_time_scale", "t_0", Dimension::Second),
        ]
    }

    fn bounds(&self, state: &JointState, index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        let travel = state.span();
        Some(if index == 0 { (1e-4 * travel, 0.5 * travel) } else { (0.01, 5.0) })
    }
}
