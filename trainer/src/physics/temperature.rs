//! B1, Bittencourt and Gunnarsson 2012: friction depends on the measured temperature.

use super::state::quantile;
use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};

pub(super) struct Temperature;

/// Least spread of temperature, in K, that can show an effect.
const LEAST_SPREAD_K: f64 = 0.5;

impl Hypothesis for Temperature {
    fn id(&self) -> EffectId {
        EffectId::Temperature
    }

    fn equation(&self) -> &'static str {
        "dF = (b_0 tanh(v/v_eps) + b_1 v) (T - T_ref)"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let Some(temperature) = &state.temperature else { return Vec::new() };
        let at = |share| quantile(temperature.iter().copied(), share);
        if at(0.99) - at(0.01) < LEAST_SPREAD_K {
            return Vec::new();
        }
        let reference = at(0.5);
        vec![vec![0.0, reference], vec![1.0, reference], vec![2.0, reference]]
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let Some(temperature) = &state.temperature else { return Vec::new() };
        let warmth = |i: usize| temperature[i] - shape[1];
        let mut columns = Vec::new();
        if shape[0] != 1.0 {
            columns.push(state.map(|i| warmth(i) * state.sign[i]));
        }
        if shape[0] != 0.0 {
            columns.push(state.map(|i| warmth(i) * state.velocity[i]));
        }
        columns
    }

    fn coefficients(&self, shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        let coulomb = ("coulomb_per_kelvin", "b_0", Dimension::TorquePerKelvin);
        let viscous = ("viscous_per_kelvin", "b_1", Dimension::TorquePerVelocityKelvin);
        match shape[0] {
            0.0 => vec![coulomb],
            1.0 => vec![viscous],
            _ => vec![coulomb, viscous],
        }
    }

    fn shape_names(&self) -> Vec<ShapeName> {
        vec![
            ShapeName::new("variant", "variant", Dimension::One),
            ShapeName::new("reference_temperature", "T_ref", Dimension::One),
        ]
    }
}
