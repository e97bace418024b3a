//! G3, Taghirad and Belanger 1998; Ruderman et al. 2009: torsion of the transmission with hysteresis over the load.

use super::state::quantile;
use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName, geometric_grid};

pub(super) struct WindupHysteresis;

/// Normalised hysteresis in [-1, 1] of a driving series with memory length `reach` (the exact exponential step).
pub(crate) fn hysteresis(state: &JointState, drive: &[f64], reach: f64) -> Vec<f64> {
    let mut memory = vec![0.0; state.len()];
    for segment in &state.segments {
        let mut z = 0.0;
        for i in segment.clone() {
            if i > segment.start {
                let step = drive[i] - drive[i - 1];
                let target = if step > 0.0 { 1.0 } else { -1.0 };
                z = target + (z - target) * (-step.abs() / reach).exp();
            }
            memory[i] = z;
        }
    }
    memory
}

/// What winds the transmission: the torsion where a second encoder shows it, else the load.
fn winding(state: &JointState) -> Option<Vec<f64>> {
    if let Some(link) = &state.link_position {
        return Some(state.map(|i| state.position[i] - link[i]));
    }
    state.load.clone()
}

impl Hypothesis for WindupHysteresis {
    fn id(&self) -> EffectId {
        EffectId::WindupHysteresis
    }

    fn equation(&self) -> &'static str {
        "dF = F_h z, dz = (sign(dw) - z) |dw| / w_h, w = torsion or transmitted load"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let Some(winding) = winding(state) else { return Vec::new() };
        let spread = |share| quantile(winding.iter().copied(), share);
        let travel = spread(0.98) - spread(0.02);
        if travel <= 0.0 {
            return Vec::new();
        }
        geometric_grid(0.05 * travel, travel, 4).into_iter().map(|reach| vec![reach]).collect()
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        winding(state).map(|winding| hysteresis(state, &winding, shape[0])).into_iter().collect()
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("hysteresis_torque", "F_h", Dimension::Torque)]
    }

    fn shape_names(&self) -> Vec<ShapeName> {
        vec![ShapeName::new("windup_reach", "w_h", Dimension::One)]
    }

    fn bounds(&self, state: &JointState, _index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        let winding = winding(state)?;
        let spread = |share| quantile(winding.iter().copied(), share);
        let travel = spread(0.98) - spread(0.02);
        Some((0.01 * travel, 3.0 * travel))
    }
}
