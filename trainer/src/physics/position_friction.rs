//! D3, Bittencourt and Gunnarsson 2012: friction depends on position without a period.

use std::f64::consts::PI;

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};

pub(super) struct PositionFriction;

/// Orders of a cosine series over the range of a channel: half periods over the range, up to four and a half periods. Chosen by
/// judgement: something narrower is a place to look at, not a law; each order more costs evidence.
pub(crate) const SERIES_ORDERS: [f64; 3] = [3.0, 6.0, 9.0];

impl Hypothesis for PositionFriction {
    fn id(&self) -> EffectId {
        EffectId::PositionFriction
    }

    fn equation(&self) -> &'static str {
        "dF = sum_j b_j cos(j pi (q - q_0)/(q_1 - q_0)) tanh(v/v_eps)"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let (low, high) = state.travel();
        if high - low <= 0.0 {
            return Vec::new();
        }
        SERIES_ORDERS.into_iter().map(|order| vec![order, low, high]).collect()
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let (order, low, high) = (shape[0] as usize, shape[1], shape[2]);
        let angle = |i: usize| PI * ((state.position[i] - low) / (high - low)).clamp(0.0, 1.0);
        (1..=order).map(|j| state.map(|i| (j as f64 * angle(i)).cos() * state.sign[i])).collect()
    }

    fn coefficients(&self, shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        const SYMBOLS: [&str; 9] = ["b_1", "b_2", "b_3", "b_4", "b_5", "b_6", "b_7", "b_8", "b_9"];
        let order = shape[0] as usize;
        SYMBOLS.iter().take(order).map(|symbol| ("position_friction_coefficient", *symbol, Dimension::Torque)).collect()
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![
            ShapeName::new("series_order", "n", Dimension::One),
            ShapeName::new("lowest_position", "q_0", Dimension::Position),
            ShapeName::new("highest_position", "q_1", Dimension::Position),
        ]
    }
}
