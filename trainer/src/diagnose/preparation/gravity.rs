//! What of the rigid body's torque hangs on the position, and how it changes there.

use crate::numerics::least_squares::least_squares;
use crate::physics::JointState;

/// What a given rigid body has beside its inertia, which goes with the acceleration; `None` where none is given.
pub(crate) fn gravity_of_body(state: &JointState) -> Option<Vec<f64>> {
    without_inertia(state, state.rigid_body.as_ref()?)
}

/// What a torque has beside what goes with the acceleration; `None` where the motion does not tell these apart.
pub(super) fn without_inertia(state: &JointState, body: &[f64]) -> Option<Vec<f64>> {
    let mut columns = vec![state.acceleration.clone(), vec![1.0; state.len()]];
    columns.extend(torques_of_position(state));
    let inertia = least_squares(&columns, body, &state.segments)?[0];
    Some(state.map(|i| body[i] - inertia * state.acceleration[i]))
}

/// Gives a state that was recorded without one the torque of a rigid body, and its load where that was not recorded either.
pub(crate) fn give_body(state: &mut JointState, body: Vec<f64>) {
    state.rigid_body = Some(body);
    if state.load.is_none() {
        state.load = state.rigid_body.clone();
        state.gravity = gravity_of_body(state);
        state.gravity_slope = slope_of_gravity(state);
    }
}

/// What of a rigid body depends on the position: sine and cosine of a joint, a slope of a linear axis.
pub(crate) fn torques_of_position(state: &JointState) -> Vec<Vec<f64>> {
    let of_position: &[fn(f64) -> f64] = if state.rotary { &[f64::sin, f64::cos] } else { &[|position| position] };
    of_position.iter().map(|torque| state.map(|i| torque(state.position[i]))).collect()
}

/// Change of gravity with the position (N m/rad) at every sample: a pendulum's in each segment, which may carry a payload of its own.
/// Zero on a linear axis, and where no gravity is given.
pub(crate) fn slope_of_gravity(state: &JointState) -> Vec<f64> {
    let mut slope = vec![0.0; state.len()];
    let Some(gravity) = state.gravity.as_ref().filter(|_| state.rotary) else { return slope };
    let mut columns = torques_of_position(state);
    columns.push(vec![1.0; state.len()]);
    for segment in &state.segments {
        if let Some(fitted) = least_squares(&columns, gravity, std::slice::from_ref(segment)) {
            let (sine, cosine) = (fitted[0], fitted[1]);
            segment.clone().for_each(|i| slope[i] = sine * columns[1][i] - cosine * columns[0][i]);
        }
    }
    slope
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::measurement::signals::Signals;

    /// A joint that swings under one payload and then under another; `rotary` or along a line.
    fn swinging(rotary: bool) -> JointState {
        let period = 0.002;
        let time: Vec<f64> = (0..12_000).map(|i| period * f64::from(i)).collect();
        let position: Vec<f64> = time.iter().map(|t| 0.7 * (1.3 * t).sin() + 0.1 * (4.1 * t).sin()).collect();
        let payload = |i: usize| if i < 6_000 { 9.0 } else { 14.0 };
        let load: Vec<f64> = position.iter().enumerate().map(|(i, q)| payload(i) * (q + 0.4).sin()).collect();
        let signals = Signals {
            period,
            torque: load.clone(),
            position,
            load: Some(load),
            segments: vec![0..6_000, 6_000..12_000],
            time,
            rotary,
            ..Signals::default()
        };
        signals.states()
    }

    #[test]
    fn each_payload_has_the_slope_of_its_own_pendulum() {
        let state = swinging(true);
        for (i, payload) in [(1_000, 9.0), (4_321, 9.0), (7_000, 14.0), (11_000, 14.0)] {
            let expected = payload * (state.position[i] + 0.4).cos();
            assert!(
                (state.gravity_slope[i] - expected).abs() < 0.02 * payload,
                "{} for {expected}",
                state.gravity_slope[i]
            );
        }
    }

    #[test]
    fn gravity_along_a_line_has_no_slope() {
        assert!(swinging(false).gravity_slope.iter().all(|slope| *slope == 0.0));
    }
}
