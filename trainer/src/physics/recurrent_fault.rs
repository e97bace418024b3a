//! F4: a short pulse at one angle of the joint or of the rotor, each turn (chipped tooth, bearing pit).

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};
use std::f64::consts::TAU;

pub(super) struct RecurrentFault;

/// Width of the pulse in turns.
const WIDTHS_TURNS: [f64; 2] = [0.02, 0.05];

impl Hypothesis for RecurrentFault {
    fn id(&self) -> EffectId {
        EffectId::RecurrentFault
    }

    fn equation(&self) -> &'static str {
        "dF = A exp((cos(N q - phi) - 1)/w^2) [tanh(v/v_eps) where it is friction]"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let (low, high) = state.travel();
        let mut orders = vec![1.0];
        orders.extend(state.gear_ratio.filter(|ratio| *ratio > 1.0));
        let mut shapes = Vec::new();
        // Recurrence shows only where the same angle comes back in another turn.
        for order in orders.into_iter().filter(|order| state.rotary && order * (high - low) > 1.5 * TAU) {
            for width in WIDTHS_TURNS {
                let places = (0.7 / width).round() as usize;
                for place in 0..places {
                    let phase = TAU * place as f64 / places as f64;
                    shapes.extend([0.0, 1.0].map(|friction| vec![order, phase, width, friction]));
                }
            }
        }
        shapes
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let (order, phase, friction) = (shape[0], shape[1], shape[3]);
        let sharpness = (TAU * shape[2]).powi(-2);
        vec![state.map(|i| {
            let pulse = (((order * state.position[i] - phase).cos() - 1.0) * sharpness).exp();
            if friction == 1.0 { pulse * state.sign[i] } else { pulse }
        })]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("fault_torque", "A", Dimension::Torque)]
    }

    fn shape_names(&self) -> Vec<ShapeName> {
        vec![
            ShapeName::new("fault_order", "N", Dimension::Order),
            ShapeName::new("fault_angle", "phi", Dimension::One),
            ShapeName::new("fault_width_turns", "w", Dimension::One),
            ShapeName::new("variant", "variant", Dimension::One),
        ]
    }

    fn bounds(&self, _state: &JointState, index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        match index {
            1 => Some((-TAU, 2.0 * TAU)),
            2 => Some((0.003, 0.2)),
            _ => None,
        }
    }

    fn step(&self, _state: &JointState, index: usize, shape: &[f64]) -> f64 {
        if index == 1 { 0.5 * TAU * shape[2] } else { 0.3 * shape[2] }
    }
}
