//! F1: beyond a limit the recorded torque is not the one that moves the joint. Either the command was recorded and the actuator
//! gives less, or the record itself stands at the limit where the joint needed more.

use super::{Dimension, EffectId, Hypothesis, JointState, Shape, ShapeName};
use crate::numerics::statistics::quantile;

pub(super) struct Saturation;

/// Quantiles of the torque at which limits are tried; refined afterwards. Chosen by judgement: a limit below the median
/// would be a wrong scale; denser to the top, where limits are usual.
const LIMIT_QUANTILES: [f64; 7] = [0.5, 0.7, 0.8, 0.88, 0.94, 0.97, 0.99];

/// Variant in which the torque that the model needs goes beyond the limit.
const NEEDED: f64 = 0.0;
/// Variant in which the recorded torque does.
const RECORDED: f64 = 1.0;

fn torque_beyond(state: &JointState, variant: f64) -> &[f64] {
    if variant == RECORDED { &state.torque } else { &state.predicted }
}

fn levels(state: &JointState, variant: f64) -> Vec<f64> {
    let at = |share| quantile(torque_beyond(state, variant).iter().map(|t| t.abs()), share);
    let lowest = if variant == RECORDED { 0.0 } else { 0.45 * at(0.998) };
    LIMIT_QUANTILES.into_iter().map(at).filter(|level| *level > lowest).collect()
}

impl Hypothesis for Saturation {
    fn id(&self) -> EffectId {
        EffectId::Saturation
    }

    fn equation(&self) -> &'static str {
        "dF = c sign(tau) max(0, |tau| - tau_max)"
    }

    fn shapes(&self, state: &JointState) -> Vec<Shape> {
        if state.commanded.is_some() {
            // The limit of an actuator whose commands are known is that of its law.
            return Vec::new();
        }
        let variants = [NEEDED, RECORDED].into_iter();
        variants.flat_map(|variant| levels(state, variant).into_iter().map(move |level| vec![level, variant])).collect()
    }

    fn columns(&self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let torque = torque_beyond(state, shape[1]);
        vec![state.map(|i| (torque[i].abs() - shape[0]).max(0.0) * torque[i].signum())]
    }

    fn slope_over_recorded_torque(&self, state: &JointState, shape: &[f64]) -> Option<Vec<f64>> {
        let is_beyond = |i: usize| f64::from(u8::from(state.torque[i].abs() > shape[0]));
        (shape[1] == RECORDED).then(|| state.map(is_beyond))
    }

    fn coefficients(&self, _shape: &[f64]) -> Vec<(&'static str, &'static str, Dimension)> {
        vec![("excess_command", "c", Dimension::One)]
    }

    fn shape_names(&self, _shape: &[f64]) -> Vec<ShapeName> {
        vec![
            ShapeName::new("torque_limit", "tau_max", Dimension::Torque),
            ShapeName::new("variant", "variant", Dimension::One),
        ]
    }

    fn bounds(&self, state: &JointState, index: usize, shape: &[f64]) -> Option<(f64, f64)> {
        let levels = levels(state, shape[1]);
        Some((*levels.first()?, *levels.last()?)).filter(|_| index == 0)
    }
}
