//! G2, Spong 1987: an elastic transmission adds -(J/k) d2(tau_l)/dt2 to the torque at the motor side.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape};

pub(super) struct Elasticity;

impl Hypothesis for Elasticity {
    fn id(&self) -> EffectId {
        EffectId::Elasticity
    }

    fn equation(&self) -> &'static str {
        "dF = -(J/k) d2(tau_l)/dt2"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        if state.rigid_body.is_some() { vec![vec![]] } else { Vec::new() }
    }

    fn only_positive(&self) -> bool {
        true
    }

    fn columns(&self, state: &JointState, _shape: &[f64]) -> Vec<Vec<f64>> {
        let Some(torque) = &state.rigid_body else { return Vec::new() };
        let mut column = state.rate_of(&state.rate_of(torque));
        column.iter_mut().for_each(|value| *value = -*value);
        vec![column]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("inverse_square_resonance", "J/k", Dimension::SecondSquared)]
    }
}
