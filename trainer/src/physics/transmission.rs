//! What the effects of a transmission have in common: how motor and link would part if nothing held them together.

use super::{EffectId, JointState, OtherJoint, Twist};
use crate::numerics::statistics::{mean, quantile};

/// Variant of a shape that works out the twist from the motor's own motion.
pub(super) const INFERRED: f64 = 0.0;
/// Variant that takes it from both encoders.
pub(super) const MEASURED: f64 = 1.0;

/// Integration steps a sample of a twist that is not linear. Chosen by judgement: a twist is then within its play or loop for
/// several steps at 1 kHz; fewer err at the flanks, more cost computing time.
pub(super) const SUBSTEPS: usize = 4;

/// Share (0..1) of the inertia that lies behind the transmission where nothing tells it. Chosen by judgement: half, as
/// of matched inertias; a wrong share scales the fitted inertia of the link and the compliance.
const LINK_SHARE: f64 = 0.5;

/// Whether a second encoder leaves this effect of the transmission possible.
pub(super) fn is_possible(state: &JointState, effect: EffectId) -> bool {
    matches!(state.twist, Twist::Unknown) || is_shown(state, effect)
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

/// The column of a shape: what the measured twist leaves behind, or the one that `inferred` works out. None where the twist was
/// measured elsewhere and this recording lacks a second encoder.
pub(super) fn column(
    state: &JointState,
    link_inertia: f64,
    variant: f64,
    inferred: impl FnOnce() -> Vec<f64>,
) -> Vec<Vec<f64>> {
    if variant == MEASURED { measured(state, link_inertia).into_iter().collect() } else { vec![inferred()] }
}

/// What the measured twist leaves behind; `None` without a second encoder.
fn measured(state: &JointState, link_inertia: f64) -> Option<Vec<f64>> {
    let link = state.link.as_ref()?;
    let (offset, _) = line_of_twist(state, link, link_inertia);
    Some(state.map(|i| {
        let twist = state.position[i] - link.position[i] - offset;
        left_behind(state, link_inertia, i, twist, state.acceleration[i] - link.acceleration[i])
    }))
}

/// Torque that the transmission carries: the link's gravity and its inertia.
pub(crate) fn carried_torque(state: &JointState, link: &OtherJoint, link_inertia: f64) -> Vec<f64> {
    let gravity = |i: usize| state.gravity.as_ref().map_or(0.0, |gravity| gravity[i]);
    state.map(|i| gravity(i) + link_inertia * link.acceleration[i])
}

/// Line of a measured twist over the torque that the transmission carries: the twist where that is nothing, which is an offset of
/// the encoders, and the compliance.
fn line_of_twist(state: &JointState, link: &OtherJoint, link_inertia: f64) -> (f64, f64) {
    let carried = carried_torque(state, link, link_inertia);
    let twist = state.map(|i| state.position[i] - link.position[i]);
    let (mean_carried, mean_twist) = (mean(&carried), mean(&twist));
    let (product, square) = carried.iter().zip(&twist).fold((0.0, 0.0), |(product, square), (carried, twist)| {
        let beyond = carried - mean_carried;
        (product + beyond * (twist - mean_twist), square + beyond * beyond)
    });
    let compliance = if square > 0.0 { product / square } else { 0.0 };
    (mean_twist - compliance * mean_carried, compliance)
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

/// Inertia of the link, where nothing tells its share of the rigid body's.
pub(crate) fn usual_link_inertia(state: &JointState) -> Option<f64> {
    nominal_inertia(state).map(|inertia| LINK_SHARE * inertia)
}

/// Acceleration of the twist while the play is open: the motor's own and that of the free link, which falls where gravity is known.
pub(super) fn opening(state: &JointState, link_inertia: f64) -> Vec<f64> {
    match &state.gravity {
        Some(gravity) => state.map(|i| state.acceleration[i] + gravity[i] / link_inertia),
        None => state.acceleration.clone(),
    }
}

/// Antiresonance in rad/s of a measured twist, by its compliance. `None` without a second encoder.
pub(super) fn antiresonance_of_twist(state: &JointState) -> Option<f64> {
    let link_inertia = usual_link_inertia(state)?;
    let (_, compliance) = line_of_twist(state, state.link.as_ref()?, link_inertia);
    Some((compliance * link_inertia).sqrt().recip()).filter(|w| w.is_finite() && *w > 0.0)
}

/// Half of what a measured twist spans, its rare ends left out. `None` without a second encoder.
pub(super) fn half_span_of_twist(state: &JointState) -> Option<f64> {
    let link = state.link.as_ref()?;
    let twist = || state.position.iter().zip(&link.position).map(|(motor, link)| motor - link);
    Some(0.5 * (quantile(twist(), 0.9) - quantile(twist(), 0.1))).filter(|half| *half > 0.0)
}
