//! Coulomb friction as solvers of constraints have it: near rest it turns over before the velocity does
//! ([`lead`](crate::samples::lead)).

use crate::diagnose::preparation::states::Prepared;
use crate::numerics::least_squares::{dot, least_squares, residual};
use crate::numerics::pattern_search::{Movable, climb};
use crate::physics::JointState;
use crate::samples::lead::TRIED_S;

/// Least share of what a law leaves otherwise that a relaxation of the simulator's constraints has to explain: most of what a solver gets
/// wrong near rest, where elasticity and memories of another kind leave more.
const LEAST_RELAXATION_SHARE: f64 = 0.3;

/// Torque that a relaxation time adds for each unit of Coulomb friction.
pub(super) fn column(state: &JointState, sign_velocity: f64, relaxation_s: f64) -> Vec<f64> {
    let next = state.map(|i| state.velocity[i] + relaxation_s * state.acceleration[i]);
    let [now, next] = [&state.velocity, &next].map(|velocity| state.averaged_sign(velocity, sign_velocity));
    state.map(|i| next[i] - now[i])
}

/// Relaxation time of friction beside filtered columns of a law, s; `None` where friction turns over with the velocity
/// or after it, or where this explains too little of what the columns leave.
pub(super) fn relaxation_time(prepared: &Prepared, columns: &[Vec<f64>], target: &[f64]) -> Option<f64> {
    let (state, runs) = (&prepared.state, prepared.open_runs());
    let left = |columns: &[Vec<f64>]| {
        let coefficients = least_squares(columns, target, &runs)?;
        let rest = residual(columns, target, &coefficients);
        Some((dot(&rest, &rest, &runs), *coefficients.last()?))
    };
    let (without, _) = left(columns)?;
    let with = |relaxation_s: f64| {
        let added = prepared.filtered(&column(state, state.sign_velocity, relaxation_s));
        // Friction that turns over after the velocity is memory of the joint.
        left(&[columns, &[added]].concat()).map_or(without, |(left, torque)| if torque > 0.0 { left } else { without })
    };
    let tried = TRIED_S.map(|time| (time, with(time)));
    let (nearest, _) = tried.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let free = Movable { index: 0, step: 0.2, low: TRIED_S[0].ln(), high: TRIED_S[7].ln() };
    let time = climb(&[nearest.ln()], &[free], |time| Some(-with(time[0].exp())))[0].exp();
    (with(time) < (1.0 - LEAST_RELAXATION_SHARE) * without).then_some(time)
}
