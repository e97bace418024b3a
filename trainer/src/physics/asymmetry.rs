//! A3, Armstrong-Helouvry 1991: friction differs between the directions.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};

pub(super) struct DirectionAsymmetry;

/// Variants of the shape: which of the two friction terms differs between the directions.
const COULOMB: f64 = 0.0;
const VISCOUS: f64 = 1.0;
const BOTH: f64 = 2.0;

impl Hypothesis for DirectionAsymmetry {
    fn id(&self) -> EffectId {
        EffectId::DirectionAsymmetry
    }

    fn equation(&self) -> &'static str {
        "dF = dF_c |tanh(v/v_eps)| + dF_v |v|"
    }

    fn shapes(&self, _state: &JointState) -> Vec<Shape> {
        vec![vec![COULOMB], vec![VISCOUS], vec![BOTH]]
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let mut columns = Vec::new();
        if shape[0] != VISCOUS {
            columns.push(state.map(|i| state.sign[i].abs()));
        }
        if shape[0] != COULOMB {
            columns.push(state.map(|i| state.velocity[i].abs()));
        }
        columns
    }

    fn coefficients(&self, shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        let coulomb = ("coulomb_asymmetry", "dF_c", Dimension::Torque);
        let viscous = ("viscous_asymmetry", "dF_v", Dimension::TorquePerVelocity);
        match shape[0] {
            COULOMB => vec![coulomb],
            VISCOUS => vec![viscous],
            _ => vec![coulomb, viscous],
        }
    }

    /// Friction opposes both directions; what drives the joint in one of them is an outer force.
    fn is_passive(&self, state: &JointState, shape: &[f64], coefficients: &[f64]) -> bool {
        let columns = self.columns(state, shape);
        let mut taken = [0.0; 2];
        for (i, &velocity) in state.velocity.iter().enumerate() {
            let differs: f64 = columns.iter().zip(coefficients).map(|(column, by)| by * column[i]).sum();
            taken[usize::from(velocity > 0.0)] += velocity * (state.base_friction_at(velocity) + differs);
        }
        taken.iter().all(|power| *power >= 0.0)
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![ShapeName::new("variant", "variant", Dimension::One)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::measurement::signals::Signals;

    #[test]
    fn friction_of_one_direction_drives_no_joint() {
        let period = 0.01;
        let time: Vec<f64> = (0..3000).map(|i| period * f64::from(i)).collect();
        let position: Vec<f64> = time.iter().map(|t| t.sin()).collect();
        let mut state = Signals::without_gap(period, time, position.clone(), position).states();
        state.base_friction = vec![(-2.0, -1.5), (-1e-3, -1.0), (1e-3, 1.0), (2.0, 1.5)];
        let is_passive = |shape: f64, by: &[f64]| DirectionAsymmetry.is_passive(&state, &[shape], by);
        assert!(is_passive(COULOMB, &[0.9]) && is_passive(BOTH, &[-0.5, 0.3]));
        assert!(!is_passive(COULOMB, &[4.0]) && !is_passive(COULOMB, &[-4.0]) && !is_passive(BOTH, &[4.0, -0.5]));
    }
}
