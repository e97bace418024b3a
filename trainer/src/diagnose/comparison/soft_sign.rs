//! The softer sign as a nuisance beside the base.

use crate::diagnose::comparison::columns::SOFT_SIGN_WIDTH_RATIO;
use crate::diagnose::preparation::states::Prepared;
use crate::numerics::least_squares::least_squares;

/// Torque of a softer sign over the friction at low speed, up to which it is friction's own softness: one, with half of
/// it for the error of the estimate. Chosen by judgement: lowered from 2; higher takes up effects at low speed.
const SOFT_SIGN_TORQUE_RATIO: f64 = 1.5;

/// Friction may turn over softly, and its torque may be that of an instant instead of a whole sample: the softer sign at the samples is
/// a nuisance beside the given columns, but where it takes more torque than friction has there or the opposite, and stands for
/// something else.
pub(crate) fn add_soft_sign(prepared: &Prepared, columns: &mut Vec<Vec<f64>>, target: &[f64]) {
    if !prepared.turns_over_sharply() {
        return;
    }
    let state = &prepared.state;
    let width = SOFT_SIGN_WIDTH_RATIO * state.sign_velocity;
    columns.push(prepared.filtered(&state.map(|i| (state.velocity[i] / width).tanh() - state.sign[i])));
    let torque =
        least_squares(columns, target, &prepared.open_runs()).and_then(|coefficients| coefficients.last().copied());
    let is_of_friction =
        |torque: f64| (0.0..=SOFT_SIGN_TORQUE_RATIO).contains(&(torque / state.base_friction_at(width)));
    if !torque.is_some_and(is_of_friction) {
        columns.pop();
    }
}
