//! G1, Nordin and Gutman 2002: play between motor and load. With a motor encoder alone it shows as a short loss of the
//! load while the play is crossed, at each change of sign of the load, and an impact at its end.

use super::state::quantile;
use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};

pub(super) struct Backlash;

impl Hypothesis for Backlash {
    fn id(&self) -> EffectId {
        EffectId::Backlash
    }

    fn equation(&self) -> &'static str {
        "dF = -c d2/dt2 tanh(tau_l / tau_w), c = load inertia times half the play"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let Some(load) = &state.load else { return Vec::new() };
        let typical = quantile(load.iter().map(|l| l.abs()), 0.7);
        let crossings = load.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
        if crossings < 4 || typical <= 0.0 {
            return Vec::new();
        }
        [0.02, 0.06, 0.18].into_iter().map(|share| vec![share * typical]).collect()
    }

    fn only_positive(&self) -> bool {
        true
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let Some(load) = &state.load else { return Vec::new() };
        let side = state.map(|i| (load[i] / shape[0]).tanh());
        let rate = state.rate_of(&side);
        let mut column = state.rate_of(&rate);
        column.iter_mut().for_each(|value| *value = -*value);
        vec![column]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("backlash_inertia", "c", Dimension::Inertia)]
    }

    fn shape_names(&self) -> Vec<ShapeName> {
        vec![ShapeName::new("contact_torque", "tau_w", Dimension::Torque)]
    }

    fn bounds(&self, state: &JointState, _index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        let typical = quantile(state.load.as_ref()?.iter().map(|l| l.abs()), 0.7);
        Some((0.005 * typical, typical))
    }
}
