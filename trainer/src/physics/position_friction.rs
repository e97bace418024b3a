//! D3, Bittencourt and Gunnarsson 2012: friction depends on position without a period.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};

pub(super) struct PositionFriction;

impl Hypothesis for PositionFriction {
    fn id(&self) -> EffectId {
        EffectId::PositionFriction
    }

    fn equation(&self) -> &'static str {
        "dF = sum_j b_j B_j(q) tanh(v/v_eps), B_j piecewise linear on even knots"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let (low, high) = state.travel();
        if high - low <= 0.0 {
            return Vec::new();
        }
        [3.0, 6.0, 10.0].into_iter().map(|knots| vec![knots, low, high]).collect()
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let (knots, low, high) = (shape[0] as usize, shape[1], shape[2]);
        let place = |q: f64| ((q - low) / (high - low)).clamp(0.0, 1.0) * (knots - 1) as f64;
        // The first knot is left out: the sum of all is Coulomb friction, which the base has.
        (1..knots)
            .map(|j| state.map(|i| (1.0 - (place(state.position[i]) - j as f64).abs()).max(0.0) * state.sign[i]))
            .collect()
    }

    fn coefficients(&self, shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        const SYMBOLS: [&str; 9] = ["b_1", "b_2", "b_3", "b_4", "b_5", "b_6", "b_7", "b_8", "b_9"];
        SYMBOLS
            .iter()
            .take(shape[0] as usize - 1)
            .map(|symbol| ("position_friction_knot", *symbol, Dimension::Torque))
            .collect()
    }

    fn shape_names(&self) -> Vec<ShapeName> {
        vec![
            ShapeName::new("knots", "n", Dimension::One),
            ShapeName::new("lowest_position", "q_0", Dimension::Position),
            ShapeName::new("highest_position", "q_1", Dimension::Position),
        ]
    }
}
