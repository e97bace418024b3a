//! Torques of effects along a recorded motion. The equations are of this file alone.

use frikan_trainer::physics::JointState;
use std::f64::consts::TAU;

/// Effects that are added.
pub const ADDED: [&str; 9] = [
    "stribeck",
    "viscous_nonlinearity",
    "direction_asymmetry",
    "torque_offset",
    "spring",
    "inertia_error",
    "slow_drift",
    "presliding",
    "position_ripple",
];

/// Torque of an effect along a recorded motion, for unit amplitude.
pub fn torque(effect: &str, state: &JointState) -> Vec<f64> {
    let speed = state.top_speed();
    let (low, high) =
        state.position.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), q| (l.min(*q), h.max(*q)));
    let span = high - low;
    let along = |of: &dyn Fn(f64, f64, usize) -> f64| -> Vec<f64> {
        (0..state.len()).map(|i| of(state.position[i], state.velocity[i], i)).collect()
    };
    match effect {
        "stribeck" => along(&|_, v, i| state.sign[i] * (-(v.abs() / (0.08 * speed))).exp()),
        "viscous_nonlinearity" => along(&|_, v, _| v * v.abs()),
        "direction_asymmetry" => along(&|_, v, _| v.abs()),
        "torque_offset" => along(&|_, _, _| 1.0),
        "spring" => along(&|q, _, _| q - low - 0.37 * span),
        "inertia_error" => along(&|_, _, i| state.acceleration[i]),
        "slow_drift" => along(&|_, _, i| state.time[i] * state.sign[i]),
        "position_ripple" => along(&|q, _, _| (23.0 * TAU * q / span + 0.4).sin()),
        "presliding" => bristle(state, 0.004 * span),
        _ => vec![0.0; state.len()],
    }
}

/// Deflection of a bristle (Dahl 1968) of the given break-away distance, less what Coulomb friction has of it.
fn bristle(state: &JointState, distance: f64) -> Vec<f64> {
    let mut deflection = 0.0f64;
    let mut before = state.position.first().copied().unwrap_or(0.0);
    (0..state.len())
        .map(|i| {
            let moved = state.position[i] - before;
            before = state.position[i];
            let end = moved.signum();
            deflection = end + (deflection - end) * (-moved.abs() / distance).exp();
            deflection - state.sign[i]
        })
        .collect()
}
