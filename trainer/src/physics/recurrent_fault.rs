//! F4: a short pulse at one angle of the joint or of the rotor, each turn (chipped tooth, bearing pit).

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};
use std::f64::consts::TAU;

pub(super) struct RecurrentFault;

/// Widths of a pulse that comes back in another turn on the grid, turns; refined afterwards up to [`WIDEST_TURNS`].
const PULSE_WIDTHS_TURNS: [f64; 2] = [0.02, 0.05];
/// Widths of a pulse that is only passed to and fro, turns. Chosen by judgement: a wider one is also a
/// position-dependent friction or torque, which would go by its name.
const SINGLE_TURN_WIDTHS_TURNS: [f64; 2] = [0.004, 0.008];
/// Largest width, turns. Chosen by judgement: a wider pulse is told from the ripple of its order by little; larger
/// names ripples as faults.
const WIDEST_TURNS: f64 = 0.08;
/// Passes of an angle from which a pulse there recurs, by definition; what is passed once is a one-off event.
const LEAST_PASSES: usize = 2;

/// Exponent above which a pulse is zero: exp(-40) is below the roundoff of its height.
const LARGEST_EXPONENT: f64 = 40.0;

impl Hypothesis for RecurrentFault {
    fn id(&self) -> EffectId {
        EffectId::RecurrentFault
    }

    fn equation(&self) -> &'static str {
        "dF = A exp((cos(N q - phi) - 1)/(2 pi w)^2) [tanh(v/v_eps) where it is friction]"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let (low, high) = state.travel();
        if !state.rotary || high <= low {
            return Vec::new();
        }
        let mut orders = vec![1.0];
        orders.extend(state.gear_ratio.filter(|ratio| *ratio > 1.0));
        let mut shapes = Vec::new();
        let (once, again): (Vec<f64>, Vec<f64>) =
            orders.into_iter().partition(|order| order * (high - low) <= 1.5 * TAU);
        for order in once {
            for width in SINGLE_TURN_WIDTHS_TURNS {
                let places = ((high - low) * order / (1.2 * TAU * width)).ceil() as usize;
                let at = |place: usize| order * (low + (high - low) * (place as f64 + 0.5) / places as f64);
                let comes_back =
                    |phase: &f64| passes(&state.position, phase / order, TAU * width / order) >= LEAST_PASSES;
                shapes.extend((0..places).map(at).filter(comes_back).map(|phase| vec![order, phase, width, 0.0]));
            }
        }
        for order in again {
            for width in PULSE_WIDTHS_TURNS {
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
            let fall = (1.0 - (order * state.position[i] - phase).cos()) * sharpness;
            let pulse = if fall < LARGEST_EXPONENT { (-fall).exp() } else { 0.0 };
            if friction == 1.0 { pulse * state.sign[i] } else { pulse }
        })]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("fault_torque", "A", Dimension::Torque)]
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![
            ShapeName::new("fault_order", "N", Dimension::Order),
            ShapeName::new("fault_angle", "phi", Dimension::One),
            ShapeName::new("fault_width_turns", "w", Dimension::One),
            ShapeName::new("variant", "variant", Dimension::One),
        ]
    }

    fn bounds(&self, _state: &JointState, index: usize, shape: &[f64]) -> Option<(f64, f64)> {
        match index {
            1 => Some((-TAU, 2.0 * TAU)),
            2 if shape[2] < PULSE_WIDTHS_TURNS[0] => {
                Some((0.5 * SINGLE_TURN_WIDTHS_TURNS[0], 1.5 * SINGLE_TURN_WIDTHS_TURNS[1]))
            }
            2 => Some((0.003, WIDEST_TURNS)),
            _ => None,
        }
    }

    fn step(&self, _state: &JointState, index: usize, shape: &[f64]) -> f64 {
        if index == 1 { 0.5 * TAU * shape[2] } else { 0.3 * shape[2] }
    }
}

/// How often positions pass through an angle, from outside `margin` on one side to outside it on the other.
fn passes(position: &[f64], angle: f64, margin: f64) -> usize {
    let beyond = position.iter().map(|q| q - angle).filter(|distance| distance.abs() > margin);
    let sides: Vec<bool> = beyond.map(|distance| distance > 0.0).collect();
    sides.windows(2).filter(|pair| pair[0] != pair[1]).count()
}

#[cfg(test)]
mod tests {
    use super::passes;

    #[test]
    fn a_jerk_within_the_margin_is_no_second_pass() {
        let once: Vec<f64> = (0..100).map(|i| 0.02 * f64::from(i) + if i % 2 == 0 { 0.03 } else { -0.03 }).collect();
        assert_eq!(passes(&once, 1.0, 0.05), 1);
        let to_and_fro: Vec<f64> = (0..100).map(|i| (0.1 * f64::from(i)).sin()).collect();
        assert_eq!(passes(&to_and_fro, 0.5, 0.05), 4);
        assert_eq!(passes(&to_and_fro, 2.0, 0.05), 0);
    }
}
