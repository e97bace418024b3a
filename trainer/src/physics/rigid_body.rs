//! E1 to E5: corrections of the rigid body and of the torque chain, linear in their coefficients
//! (Atkeson, An and Hollerbach 1986; Gautier and Khalil 1990; Gautier and Briot 2014).

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};
use crate::numerics::statistics::quantile;

pub(super) struct GravityError;

impl Hypothesis for GravityError {
    fn id(&self) -> EffectId {
        EffectId::GravityError
    }

    fn equation(&self) -> &'static str {
        "dF = g_c cos(q) + g_s sin(q)"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        if state.rotary { vec![vec![0.0], vec![1.0], vec![2.0]] } else { Vec::new() }
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let mut columns = Vec::new();
        if shape[0] != 1.0 {
            columns.push(state.map(|i| state.position[i].cos()));
        }
        if shape[0] != 0.0 {
            columns.push(state.map(|i| state.position[i].sin()));
        }
        columns
    }

    fn coefficients(&self, shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        let cosine = ("gravity_cosine_torque", "g_c", Dimension::Torque);
        let sine = ("gravity_sine_torque", "g_s", Dimension::Torque);
        match shape[0] {
            0.0 => vec![cosine],
            1.0 => vec![sine],
            _ => vec![cosine, sine],
        }
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![ShapeName::new("variant", "variant", Dimension::One)]
    }
}

pub(super) struct InertiaError;

impl Hypothesis for InertiaError {
    fn id(&self) -> EffectId {
        EffectId::InertiaError
    }

    fn equation(&self) -> &'static str {
        "dF = dJ a"
    }

    fn shapes(&self, _state: &JointState) -> Vec<Shape> {
        vec![vec![]]
    }

    fn columns(&self, state: &JointState, _shape: &[f64]) -> Vec<Vec<f64>> {
        vec![state.acceleration.clone()]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("inertia_correction", "dJ", Dimension::Inertia)]
    }
}

pub(super) struct TorqueScale;

impl Hypothesis for TorqueScale {
    fn id(&self) -> EffectId {
        EffectId::TorqueScale
    }

    fn equation(&self) -> &'static str {
        "dF = epsilon tau_rigid"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        match &state.rigid_body {
            Some(torque) if quantile(torque.iter().map(|t| t.abs()), 0.9) > 0.0 => vec![vec![]],
            _ => Vec::new(),
        }
    }

    fn columns(&self, state: &JointState, _shape: &[f64]) -> Vec<Vec<f64>> {
        state.rigid_body.clone().into_iter().collect()
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("torque_scale_error", "epsilon", Dimension::One)]
    }
}

pub(super) struct TorqueOffset;

impl Hypothesis for TorqueOffset {
    fn id(&self) -> EffectId {
        EffectId::TorqueOffset
    }

    fn equation(&self) -> &'static str {
        "dF = tau_0"
    }

    fn shapes(&self, _state: &JointState) -> Vec<Shape> {
        vec![vec![]]
    }

    fn columns(&self, state: &JointState, _shape: &[f64]) -> Vec<Vec<f64>> {
        vec![vec![1.0; state.len()]]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("torque_offset", "tau_0", Dimension::Torque)]
    }
}

pub(super) struct Spring;

impl Hypothesis for Spring {
    fn id(&self) -> EffectId {
        EffectId::Spring
    }

    fn equation(&self) -> &'static str {
        "dF = k_c q [+ tau_0]"
    }

    fn shapes(&self, _state: &JointState) -> Vec<Shape> {
        vec![vec![0.0], vec![1.0]]
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let mut columns = vec![state.position.clone()];
        if shape[0] == 1.0 {
            columns.push(vec![1.0; state.len()]);
        }
        columns
    }

    fn coefficients(&self, shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        let stiffness = ("spring_stiffness", "k_c", Dimension::TorquePerPosition);
        if shape[0] == 1.0 { vec![stiffness, ("spring_preload", "tau_0", Dimension::Torque)] } else { vec![stiffness] }
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![ShapeName::new("variant", "variant", Dimension::One)]
    }
}
