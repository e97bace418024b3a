//! What the effects of a transmission have in common: how motor and link would part if nothing held them together.

use super::{EffectId, JointState, OtherJoint, Twist};
use crate::statistics::quantile;

/// Variant of a shape that works out the twist from the motor's own motion, and the one that takes it from both encoders.
pub(super) const INFERRED: f64 = 0.0;
pub(super) const MEASURED: f64 = 1.0;

/// Share of the inertia that lies behind the transmission, where nothing tells it.
pub(super) const LINK_SHARE: f64 = 0.5;

/// Whether a second encoder leaves this effect of the transmission possible.
pub(super) fn is_possible(state: &JointState, effect: EffectId) -> bool {
    matches!(state.twist, Twist::Untold) || is_shown(state, effect)
}

/// Whether a second encoder shows this effect of the transmission.
pub(super) fn is_shown(state: &JointState, effect: EffectId) -> bool {
    state.twist == Twist::Shows(effect)
}

/// What a twist takes off the motor's torque at a sample, over the inertia of the link: that accelerates less than the motor by
/// `bend`, and feels gravity where it is itself.
pub(super) fn left_behind(state: &JointState, link_inertia: f64, sample: usize, twist: f64, bend: f64) -> f64 {
    -bend - state.gravity_slope[sample] / link_inertia * twist
}

/// The same of the measured twist; empty without a second encoder.
pub(super) fn measured(state: &JointState, link_inertia: f64) -> Vec<f64> {
    let Some(link) = &state.link else { return Vec::new() };
    let mean = mean_twist(state, link);
    state.map(|i| {
        let twist = state.position[i] - link.position[i] - mean;
        left_behind(state, link_inertia, i, twist, state.acceleration[i] - link.acceleration[i])
    })
}

/// Offset of two encoders.
fn mean_twist(state: &JointState, link: &OtherJoint) -> f64 {
    let twists = state.position.iter().zip(&link.position).map(|(motor, link)| motor - link);
    twists.sum::<f64>() / state.len().max(1) as f64
}

/// Inertia of the nominal rigid body: what its torque beyond gravity shows per acceleration.
pub(crate) fn nominal_inertia(state: &JointState) -> Option<f64> {
    let (body, gravity) = (state.rigid_body.as_ref()?, state.gravity.as_ref()?);
    let (mut product, mut square) = (0.0, 0.0);
    for ((b, g), a) in body.iter().zip(gravity).zip(&state.acceleration) {
        product += (b - g) * a;
        square += a * a;
    }
    Some(product / square).filter(|inertia| *inertia > 0.0)
}

/// Acceleration of the twist while the play is open: the motor's own and that of the free link.
pub(super) fn opening(state: &JointState, link_inertia: f64) -> Vec<f64> {
    match &state.gravity {
        Some(gravity) => state.map(|i| state.acceleration[i] + gravity[i] / link_inertia),
        None => Vec::new(),
    }
}

/// Antiresonance in rad/s of a measured twist: what the link's acceleration shows per twist. `None` without a second encoder.
pub(super) fn antiresonance_of_twist(state: &JointState) -> Option<f64> {
    let link = state.link.as_ref()?;
    let twist = state.map(|i| state.position[i] - link.position[i]);
    let mean = mean_twist(state, link);
    let (product, square) = twist.iter().zip(&link.acceleration).fold((0.0, 0.0), |(product, square), (twist, a)| {
        (product + (twist - mean) * a, square + (twist - mean).powi(2))
    });
    Some((product / square).sqrt()).filter(|w| w.is_finite() && *w > 0.0)
}

/// Half of what a measured twist spans, its rare ends left out. `None` without a second encoder.
pub(super) fn half_span_of_twist(state: &JointState) -> Option<f64> {
    let link = state.link.as_ref()?;
    let twist = || state.position.iter().zip(&link.position).map(|(motor, link)| motor - link);
    Some(0.5 * (quantile(twist(), 0.9) - quantile(twist(), 0.1))).filter(|half| *half > 0.0)
}
