//! E6, Swevers et al. 1997: inertial and centrifugal coupling from another joint on the same clock.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};

pub(super) struct Coupling;

impl Hypothesis for Coupling {
    fn id(&self) -> EffectId {
        EffectId::Coupling
    }

    fn equation(&self) -> &'static str {
        "dF = m_12 a_2 [+ c_1 v_2^2 + c_2 v v_2]"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        (0..state.other_joints.len()).flat_map(|joint| [vec![joint as f64, 0.0], vec![joint as f64, 1.0]]).collect()
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let Some(other) = state.other_joints.get(shape[0] as usize) else { return Vec::new() };
        let mut columns = vec![other.acceleration.clone()];
        if shape[1] == 1.0 {
            columns.push(state.map(|i| other.velocity[i] * other.velocity[i]));
            columns.push(state.map(|i| state.velocity[i] * other.velocity[i]));
        }
        columns
    }

    fn coefficients(&self, shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        let mut coefficients = vec![("coupling_inertia", "m_12", Dimension::Inertia)];
        if shape[1] == 1.0 {
            coefficients.push(("centrifugal_coupling", "c_1", Dimension::TorquePerVelocitySquared));
            coefficients.push(("coriolis_coupling", "c_2", Dimension::TorquePerVelocitySquared));
        }
        coefficients
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![ShapeName::new("other_joint", "j", Dimension::One), ShapeName::new("variant", "variant", Dimension::One)]
    }
}
