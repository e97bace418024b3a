//! H1: the torque channel is late against the position by a delay d, which adds the odd part
//! (tau(t-d) - tau(t+d))/2 of the whole torque.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape};

pub(super) struct TimeMisalignment;

impl Hypothesis for TimeMisalignment {
    fn id(&self) -> EffectId {
        EffectId::TimeMisalignment
    }

    fn equation(&self) -> &'static str {
        "dF = -d dtau/dt"
    }

    fn shapes(&self, _state: &JointState) -> Vec<Shape> {
        vec![vec![]]
    }

    fn columns(&self, state: &JointState, _shape: &[f64]) -> Vec<Vec<f64>> {
        let mut column = state.rate_of(&state.predicted);
        column.iter_mut().for_each(|value| *value = -*value);
        vec![column]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("torque_delay", "d", Dimension::Second)]
    }
}
