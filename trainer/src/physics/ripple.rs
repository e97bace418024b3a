//! D1, Holtz and Springob 1996; Piccoli and Yim 2016: torque ripple at fixed orders of position.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};
use crate::numerics::statistics::quantile;

pub(super) struct PositionRipple;

/// Variant of a torque that does not turn with the direction (cogging).
pub(crate) const COGGING: f64 = 0.0;
/// Variant of a friction, which turns with the direction.
pub(crate) const FRICTION: f64 = 1.0;

/// Periods over the travel, above which a wave is a ripple. Chosen by judgement: one of fewer is gravity or
/// position-dependent friction, whose series reach four and a half.
const LEAST_PERIODS: f64 = 3.0;

/// Orders (rad of phase per unit of position) between three periods a travel and what the sampling can follow.
///
/// Steps are fine enough that an order between two steps keeps most of its power; whole orders where the joint
/// turns through more than one turn.
pub(crate) fn orders(state: &JointState, most: usize) -> Vec<f64> {
    let travel = state.span();
    if travel <= 0.0 {
        return Vec::new();
    }
    let turn = std::f64::consts::TAU;
    let lowest = LEAST_PERIODS * turn / travel;
    let step = if state.rotary && travel > turn { 1.0 } else { 0.5 * turn / travel };
    let typical_speed = quantile(state.velocity.iter().map(|v| v.abs()), 0.7).max(f64::MIN_POSITIVE);
    // Ten samples a period at a typical speed, or the encoder's own grain.
    let highest = (turn / (10.0 * state.period * typical_speed)).min(turn / (8.0 * state.resolution.max(1e-12)));
    let first = if step == 1.0 { lowest.ceil() } else { lowest };
    let mut orders: Vec<f64> = (0..most).map(|i| first + step * i as f64).collect();
    // What the motor and its wave generator turn with, where the free scan does not come to it.
    orders.extend(state.gear_ratio.iter().flat_map(|ratio| [1.0, 2.0, 4.0].map(|times| times * ratio)));
    orders.retain(|order| (lowest..=highest).contains(order));
    orders
}

impl Hypothesis for PositionRipple {
    fn id(&self) -> EffectId {
        EffectId::PositionRipple
    }

    fn equation(&self) -> &'static str {
        "dF = (A cos(k q) + B sin(k q)) [tanh(v/v_eps) where it is friction]"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        orders(state, 90).into_iter().flat_map(|k| [vec![k, COGGING], vec![k, FRICTION]]).collect()
    }

    fn repeats(&self) -> bool {
        true
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let order = shape[0];
        let (mut cosine, mut sine): (Vec<f64>, Vec<f64>) =
            state.position.iter().map(|q| (order * q).sin_cos()).map(|(s, c)| (c, s)).unzip();
        if shape[1] == FRICTION {
            for column in [&mut cosine, &mut sine] {
                column.iter_mut().zip(&state.sign).for_each(|(value, sign)| *value *= sign);
            }
        }
        vec![cosine, sine]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("ripple_cosine_amplitude", "A", Dimension::Torque), ("ripple_sine_amplitude", "B", Dimension::Torque)]
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![
            ShapeName::new("ripple_order", "k", Dimension::Order),
            ShapeName::new("variant", "variant", Dimension::One),
        ]
    }

    fn bounds(&self, state: &JointState, index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        (index == 0).then(|| (LEAST_PERIODS * std::f64::consts::TAU / state.span(), f64::INFINITY))
    }

    fn step(&self, state: &JointState, _index: usize, _shape: &[f64]) -> f64 {
        step_of_order(state)
    }
}

/// Step of an order in its refinement: a fifth of a period over the whole travel.
pub(super) fn step_of_order(state: &JointState) -> f64 {
    0.2 * std::f64::consts::TAU / state.span().max(f64::MIN_POSITIVE)
}
