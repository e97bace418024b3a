//! F2, Haddadin, De Luca and Albu-Schaeffer 2017: a one-sided stop or contact, a spring with a damper (Gilardi and Sharf 2002).

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};
use crate::numerics::statistics::quantile;

pub(super) struct Contact;

/// Shares of the positions short of a stop that are tried: a stop may be met for a moment only.
const TRIED_SHARES: [f64; 8] = [0.8, 0.86, 0.9, 0.94, 0.97, 0.99, 0.997, 0.999];
/// Least and most of these shares. In the middle of the travel a stop would pass for a spring.
const SHARES: (f64, f64) = (0.65, 0.9998);

impl Hypothesis for Contact {
    fn id(&self) -> EffectId {
        EffectId::Contact
    }

    fn equation(&self) -> &'static str {
        "dF = k_s side max(0, side (q - q_s)) + d_s v [side (q - q_s) > 0]"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        TRIED_SHARES
            .into_iter()
            .flat_map(|share| {
                let at = |share| quantile(state.position.iter().copied(), share);
                [vec![at(share), 1.0], vec![at(1.0 - share), -1.0]]
            })
            .collect()
    }

    fn only_positive(&self) -> bool {
        true
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let depth = |i: usize| shape[1] * (state.position[i] - shape[0]);
        vec![
            state.map(|i| shape[1] * depth(i).max(0.0)),
            state.map(|i| if depth(i) > 0.0 { state.velocity[i] } else { 0.0 }),
        ]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![
            ("contact_stiffness", "k_s", Dimension::TorquePerPosition),
            ("contact_damping", "d_s", Dimension::TorquePerVelocity),
        ]
    }

    fn shape_names(&self) -> Vec<ShapeName> {
        vec![
            ShapeName::new("contact_position", "q_s", Dimension::Position),
            ShapeName::new("side", "side", Dimension::One),
        ]
    }

    fn bounds(&self, state: &JointState, index: usize, shape: &[f64]) -> Option<(f64, f64)> {
        let at = |share| quantile(state.position.iter().copied(), share);
        let (least, most) = SHARES;
        (index == 0).then(|| if shape[1] > 0.0 { (at(least), at(most)) } else { (at(1.0 - most), at(1.0 - least)) })
    }

    fn step(&self, state: &JointState, _index: usize, _shape: &[f64]) -> f64 {
        0.02 * state.span()
    }
}
