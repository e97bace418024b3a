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

    fn shape_names(&self) -> Vec<ShapeName> {
        vec![ShapeName::new("variant", "variant", Dimension::One)]
    }
}
