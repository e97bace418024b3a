//! H9: the firmware does nothing about a position error within a band.

use super::{missing_torque, motion};
use crate::actuator::{Actuator, Command};
use crate::numerics::statistics::quantile;
use crate::physics::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName, geometric_grid};

pub(in crate::physics) struct DeadBand;

/// Widths that are tried, shares of the error that nine of ten samples stay below; refined afterwards. A wider band is a wrong gain.
const SHARES: (f64, f64) = (0.05, 0.8);
const STEPS: usize = 6;

/// Position error that nine of ten samples stay below, rad; zero where nothing follows a position.
fn common_error(state: &JointState) -> f64 {
    let Some(commanded) = &state.commanded else { return 0.0 };
    let error = |actuator: &Actuator, command: &Command, i: usize| {
        if actuator.kind.follows_position() { (command.reference - motion(state, i).position).abs() } else { 0.0 }
    };
    quantile(commanded.map(error).into_iter(), 0.9)
}

impl Hypothesis for DeadBand {
    fn id(&self) -> EffectId {
        EffectId::DeadBand
    }

    fn equation(&self) -> &'static str {
        "dF = c (tau(e) - tau(e less the band))"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let common = common_error(state);
        let widths = geometric_grid(SHARES.0 * common, SHARES.1 * common, STEPS);
        widths.into_iter().filter(|width| *width > 0.0).map(|width| vec![width]).collect()
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let wider = |actuator: &Actuator| Actuator { dead_band: actuator.dead_band.max(shape[0]), ..*actuator };
        vec![missing_torque(state, |commanded| commanded.with(wider))]
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("withheld_share", "c", Dimension::One)]
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![ShapeName::new("dead_band", "e_0", Dimension::Position)]
    }

    fn only_positive(&self) -> bool {
        true
    }

    fn known_coefficient(&self, _shape: &[f64]) -> Option<f64> {
        Some(1.0)
    }

    fn bounds(&self, state: &JointState, _index: usize, _shape: &[f64]) -> Option<(f64, f64)> {
        let common = common_error(state);
        Some((SHARES.0 * common, SHARES.1 * common))
    }
}
