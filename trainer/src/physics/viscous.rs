//! A2, Wolf and Iskandar 2018: viscous friction with an exponent other than one.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};

pub(super) struct ViscousNonlinearity;

impl Hypothesis for ViscousNonlinearity {
    fn id(&self) -> EffectId {
        EffectId::ViscousNonlinearity
    }

    fn equation(&self) -> &'static str {
        "dF = F_p |v|^p tanh(v/v_eps)"
    }

    fn shapes(&self, _state: &JointState) -> Vec<Shape> {
        [0.5, 0.67, 1.5, 2.0, 3.0].into_iter().map(|p| vec![p]).collect()
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        vec![state.map(|i| state.velocity[i].abs().powf(shape[0]) * state.sign[i])]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("power_law_coefficient", "F_p", Dimension::TorquePerVelocityPower)]
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![ShapeName::new("viscous_exponent", "p", Dimension::One)]
    }

    fn bounds(&self, _state: &JointState, _index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        Some((0.3, 4.0))
    }
}
