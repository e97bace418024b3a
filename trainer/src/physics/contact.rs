//! F2, Haddadin, De Luca and Albu-Schaeffer 2017: a one-sided stop or contact.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};
use crate::numerics::statistics::quantile;

pub(super) struct Contact;

impl Hypothesis for Contact {
    fn id(&self) -> EffectId {
        EffectId::Contact
    }

    fn equation(&self) -> &'static str {
        "dF = k_s max(0, side (q - q_s))"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        [0.8, 0.86, 0.9, 0.94, 0.97, 0.99]
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
        vec![state.map(|i| shape[1] * (shape[1] * (state.position[i] - shape[0])).max(0.0))]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("contact_stiffness", "k_s", Dimension::TorquePerPosition)]
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![
            ShapeName::new("contact_position", "q_s", Dimension::Position),
            ShapeName::new("side", "side", Dimension::One),
        ]
    }

    fn bounds(&self, state: &JointState, index: usize, shape: &[f64]) -> Option<(f64, f64)> {
        // A stop stands towards an end of the travel: in the middle it would pass for a spring.
        let at = |share| quantile(state.position.iter().copied(), share);
        (index == 0).then(|| if shape[1] > 0.0 { (at(0.65), at(0.995)) } else { (at(0.005), at(0.35)) })
    }

    fn step(&self, state: &JointState, _index: usize, _shape: &[f64]) -> f64 {
        0.02 * state.span()
    }
}
