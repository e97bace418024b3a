//! D2, Tuttle and Seering 1996; Ghorbel, Gandhi and Alpeter 2001: position error of the gear, periodic in position,
//! felt with one encoder as an inertial torque that grows with the square of speed.

use super::ripple::{orders, step_of_order};
use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};

pub(super) struct KinematicError;

impl Hypothesis for KinematicError {
    fn id(&self) -> EffectId {
        EffectId::KinematicError
    }

    fn equation(&self) -> &'static str {
        "dF = d2/dt2 (A cos(k q) + B sin(k q)), A and B = inertia times amplitude"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        orders(state, 60).into_iter().map(|k| vec![k]).collect()
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let order = shape[0];
        let (cosine, sine) = (0..state.len())
            .map(|i| {
                let (sin, cos) = (order * state.position[i]).sin_cos();
                let (speed, acceleration) = (order * state.velocity[i], order * state.acceleration[i]);
                (-speed * speed * cos - acceleration * sin, -speed * speed * sin + acceleration * cos)
            })
            .unzip();
        vec![cosine, sine]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![
            ("kinematic_cosine_amplitude", "A", Dimension::InertiaPosition),
            ("kinematic_sine_amplitude", "B", Dimension::InertiaPosition),
        ]
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![ShapeName::new("kinematic_order", "k", Dimension::Order)]
    }

    fn bounds(&self, _state: &JointState, _index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        Some((0.0, f64::INFINITY))
    }

    fn step(&self, state: &JointState, _index: usize, _shape: &[f64]) -> f64 {
        step_of_order(state)
    }
}
