//! H9: the firmware does nothing about a position error within a band.

use super::{missing_torque, motion};
use crate::actuator::{Actuator, Command};
use crate::numerics::statistics::quantile;
use crate::physics::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName, geometric_grid};

pub(in crate::physics) struct DeadBand;

/// Widths that are tried, shares of the error that nine of ten samples stay below; refined afterwards. A wider band is a wrong gain.
const SHARES: (f64, f64) = (0.05, 0.8);
const STEPS: usize = 6;
/// Widest band of a joint that turns, rad: twice the most that firmwares of servos take (32 of 4096 steps a turn, Feetech STS series; the 10 us of an
/// RC servo are 0.03 rad). Within a wider one the recorded torque is made of the error alone, and would explain itself.
const WIDEST_RAD: f64 = 0.1;

/// Position error that nine of ten samples stay below, rad, of those at which the actuator is on; zero where nothing follows a position.
fn common_error(state: &JointState) -> f64 {
    let Some(commanded) = &state.commanded else { return 0.0 };
    let error = |actuator: &Actuator, command: &Command, i: usize| {
        let follows = actuator.kind.follows_position() && command.enabled;
        if follows { (command.reference - motion(state, i).position).abs() } else { f64::NAN }
    };
    let errors = commanded.map(error);
    quantile(errors.into_iter().filter(|error| !error.is_nan()), 0.9)
}

/// Narrowest and widest band that the recording can show, rad.
fn widths(state: &JointState) -> (f64, f64) {
    let common = common_error(state);
    let widest = if state.rotary { WIDEST_RAD } else { f64::INFINITY };
    let high = (SHARES.1 * common).min(widest);
    (high * SHARES.0 / SHARES.1, high)
}

impl Hypothesis for DeadBand {
    fn id(&self) -> EffectId {
        EffectId::DeadBand
    }

    fn equation(&self) -> &'static str {
        "dF = c (tau(e) - tau(e less the band))"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        let (low, high) = widths(state);
        geometric_grid(low, high, STEPS).into_iter().filter(|width| *width > 0.0).map(|width| vec![width]).collect()
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
        Some(widths(state))
    }
}
