//! What the effects of a transmission have in common: how motor and link would part if nothing held them together.

use super::JointState;

/// Inertia of the nominal rigid body: what its torque beyond the load shows per acceleration.
pub(super) fn nominal_inertia(state: &JointState) -> Option<f64> {
    let (body, load) = (state.rigid_body.as_ref()?, state.load.as_ref()?);
    let (mut product, mut square) = (0.0, 0.0);
    for ((b, l), a) in body.iter().zip(load).zip(&state.acceleration) {
        product += (b - l) * a;
        square += a * a;
    }
    Some(product / square).filter(|inertia| *inertia > 0.0)
}

/// Acceleration of the twist while the play is open: the motor's own and that of the free link.
pub(super) fn opening(state: &JointState, link_inertia: f64) -> Vec<f64> {
    match &state.load {
        Some(load) => state.map(|i| state.acceleration[i] + load[i] / link_inertia),
        None => Vec::new(),
    }
}
