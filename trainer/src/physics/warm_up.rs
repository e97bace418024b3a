//! B2, Simoni, Beschi, Legnani and Visioli 2015: warm-up by the joint's own dissipated power, without a sensor.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName, geometric_grid};
use crate::numerics::statistics::mean;

pub(super) struct WarmUp;

/// Shortest thermal time constant, s. Chosen by judgement: no joint, however light, warms up faster; what decays sooner
/// is memory of the contact.
const LEAST_TIME_CONSTANT_S: f64 = 5.0;

/// Power that friction dissipates, smoothed over the thermal time constant, in W: h <- h + (1 - exp(-dt/tau)) (P - h), cold at the start. Over a
/// gap the joint cools, or warms as usual where it went on between the stretches of an excerpt.
pub(crate) fn smoothed_power(state: &JointState, time_constant: f64) -> Vec<f64> {
    let step = 1.0 - (-state.period / time_constant).exp();
    let power: Vec<f64> =
        state.velocity.iter().map(|velocity| (state.base_friction_at(*velocity) * velocity).abs()).collect();
    let over_gaps = if state.is_excerpt { mean(&power) } else { 0.0 };
    let mut warmth = 0.0;
    let mut before = f64::NEG_INFINITY;
    let mut smooth = |(time, power): (&f64, &f64)| {
        let gap = time - before;
        if gap.is_finite() && gap > 2.0 * state.period {
            warmth = over_gaps + (warmth - over_gaps) * (-gap / time_constant).exp();
        }
        before = *time;
        warmth += step * (power - warmth);
        warmth
    };
    state.time.iter().zip(&power).map(&mut smooth).collect()
}

impl Hypothesis for WarmUp {
    fn id(&self) -> EffectId {
        EffectId::WarmUp
    }

    fn equation(&self) -> &'static str {
        "dF = h (b_0 tanh(v/v_eps) + b_1 v), tau_th dh/dt = |F v| - h"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let duration = state.duration();
        if duration < 2.0 * LEAST_TIME_CONSTANT_S {
            return Vec::new();
        }
        geometric_grid((0.08 * duration).max(LEAST_TIME_CONSTANT_S), 3.0 * duration, 4)
            .into_iter()
            .flat_map(|tau| [vec![tau, 0.0], vec![tau, 1.0], vec![tau, 2.0]])
            .collect()
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let warmth = smoothed_power(state, shape[0]);
        let mut columns = Vec::new();
        if shape[1] != 1.0 {
            columns.push(state.map(|i| warmth[i] * state.sign[i]));
        }
        if shape[1] != 0.0 {
            columns.push(state.map(|i| warmth[i] * state.velocity[i]));
        }
        columns
    }

    fn coefficients(&self, shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        let coulomb = ("coulomb_per_watt", "b_0", Dimension::TorquePerWatt);
        let viscous = ("viscous_per_watt", "b_1", Dimension::TorquePerWattVelocity);
        match shape[1] {
            0.0 => vec![coulomb],
            1.0 => vec![viscous],
            _ => vec![coulomb, viscous],
        }
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![
            ShapeName::new("thermal_time_constant", "tau_th", Dimension::Second),
            ShapeName::new("variant", "variant", Dimension::One),
        ]
    }

    fn yields_to(&self) -> Option<(EffectId, f64)> {
        Some((EffectId::Temperature, 2.0))
    }

    fn bounds(&self, state: &JointState, index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        (index == 0).then(|| ((0.02 * state.duration()).max(LEAST_TIME_CONSTANT_S), 3.0 * state.duration()))
    }
}
