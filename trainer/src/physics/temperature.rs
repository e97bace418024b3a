//! B1, Bittencourt and Gunnarsson 2012: friction depends on the measured temperature, its dry part linearly, its viscous
//! part linearly or as the viscosity of a grease that falls exponentially.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};
use crate::numerics::statistics::quantile;

pub(super) struct Temperature;

/// Spread of the temperature (98 % of the samples), K, above which its effect is looked for. Chosen by judgement: the
/// step of a coarse sensor, over which a viscosity changes by one or two per cent.
const LEAST_SPREAD_K: f64 = 0.5;
/// Relative fall of a grease's viscosity with temperature that is tried first, 1/K, which halves it over 23 K; refined
/// within [`VISCOSITY_DECAY_RANGE_PER_K`].
const VISCOSITY_DECAY_PER_K: f64 = 0.03;
/// Range of that fall, 1/K: halved over 139 K to halved over 6 K. Chosen by judgement: beyond either end it is linear,
/// or a step.
const VISCOSITY_DECAY_RANGE_PER_K: (f64, f64) = (0.005, 0.12);

impl Hypothesis for Temperature {
    fn id(&self) -> EffectId {
        EffectId::Temperature
    }

    fn equation(&self) -> &'static str {
        "dF = b_0 tanh(v/v_eps) (T - T_ref) + b_1 v (1 - exp(-k (T - T_ref))) / k"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let Some(temperature) = &state.temperature else { return Vec::new() };
        let at = |share| quantile(temperature.iter().copied(), share);
        if at(0.99) - at(0.01) < LEAST_SPREAD_K {
            return Vec::new();
        }
        let reference = at(0.5);
        let viscous = |variant| [0.0, VISCOSITY_DECAY_PER_K].map(|decay| vec![variant, reference, decay]);
        [vec![vec![0.0, reference, 0.0]], viscous(1.0).into(), viscous(2.0).into()].concat()
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let Some(temperature) = &state.temperature else { return Vec::new() };
        let warmth = |i: usize| temperature[i] - shape[1];
        let mut columns = Vec::new();
        if shape[0] != 1.0 {
            columns.push(state.map(|i| warmth(i) * state.sign[i]));
        }
        if shape[0] != 0.0 {
            let decay = shape[2];
            let thinned = |warmth: f64| if decay > 0.0 { -(-decay * warmth).exp_m1() / decay } else { warmth };
            columns.push(state.map(|i| thinned(warmth(i)) * state.velocity[i]));
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

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![
            ShapeName::new("variant", "variant", Dimension::One),
            ShapeName::new("reference_temperature", "T_ref", Dimension::Celsius),
            ShapeName::new("viscosity_decay", "k", Dimension::PerKelvin),
        ]
    }

    fn bounds(&self, _state: &JointState, index: usize, shape: &[f64]) -> Option<(f64, f64)> {
        (index == 2 && shape[2] > 0.0).then_some(VISCOSITY_DECAY_RANGE_PER_K)
    }
}
