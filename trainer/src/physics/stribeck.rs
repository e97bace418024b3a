//! A1, Stribeck 1902; Bo and Pavelescu 1982: friction falls from break-away to Coulomb level over `v_s`.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName, geometric_grid};

pub(super) struct Stribeck;

/// Largest Stribeck velocity over the top speed. Chosen by judgement: beyond it the law is a curved viscous one over
/// all recorded speeds; smaller misses slow motions.
const LARGEST_VELOCITY_SHARE: f64 = 0.3;

/// Narrower than this it could not be told from the width of the smoothed sign, or from a reversal between two samples.
fn narrowest(state: &JointState) -> f64 {
    let seen = (4.0 * state.sign_velocity).max(state.resolved_speed());
    seen.max(0.008 * state.top_speed()).min(0.1 * state.top_speed())
}

impl Hypothesis for Stribeck {
    fn id(&self) -> EffectId {
        EffectId::Stribeck
    }

    fn equation(&self) -> &'static str {
        "dF = F_s exp(-(|v|/v_s)^alpha) tanh(v/v_eps)"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let top = state.top_speed();
        let low = narrowest(state);
        geometric_grid(low, LARGEST_VELOCITY_SHARE * top, 7)
            .into_iter()
            .flat_map(|v| [vec![v, 1.0], vec![v, 2.0]])
            .collect()
    }

    fn only_positive(&self) -> bool {
        true
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let (stribeck_velocity, exponent) = (shape[0], shape[1]);
        let decay = |speed: f64| match exponent {
            1.0 => (-speed / stribeck_velocity).exp(),
            2.0 => (-(speed / stribeck_velocity).powi(2)).exp(),
            _ => (-(speed / stribeck_velocity).powf(exponent)).exp(),
        };
        vec![state.map(|i| decay(state.velocity[i].abs()) * state.sign[i])]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("stribeck_extra_torque", "F_s", Dimension::Torque)]
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![
            ShapeName::new("stribeck_velocity", "v_s", Dimension::Velocity),
            ShapeName::new("stribeck_exponent", "alpha", Dimension::One),
        ]
    }

    fn bounds(&self, state: &JointState, index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        Some(if index == 0 { (narrowest(state), LARGEST_VELOCITY_SHARE * state.top_speed()) } else { (0.5, 2.5) })
    }
}
