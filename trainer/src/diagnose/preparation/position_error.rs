//! What is wrong with a recorded position, and how much of the torque that explains: the encoder's grain, and the scatter of the
//! instants of sampling.

use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::states::{Prepared, identified_inertia, simplest_model};
use crate::numerics::least_squares::{dot, fit_residual, rows_in};
use crate::numerics::statistics::root_mean_square;

/// Torque that the errors of the position make through the inertia over what the simplest model leaves (root mean
/// squares), up to which a cut-off is taken. Raised from 0.1 when the evidence of that torque began to be taken off
/// every candidate; larger leaves more of it to the candidates, smaller narrows the band.
const POSITION_ERROR_SHARE: f64 = 0.4;
/// Standard deviation of the recorded position, in its unit.
fn position_error(prepared: &Prepared, signals: &Signals) -> f64 {
    let speed = root_mean_square(&prepared.state.velocity);
    (signals.position_resolution.powi(2) / 12.0 + (prepared.sampling_jitter * speed).powi(2)).sqrt()
}

/// Whether encoder noise, through the inertia, stays small against what the simplest model leaves.
pub(crate) fn encoder_noise_is_small(prepared: &Prepared, signals: &Signals) -> bool {
    if position_error(prepared, signals) == 0.0 {
        return true;
    }
    let rows = prepared.open_runs();
    let columns = simplest_model(prepared);
    let Some(grain) = position_error_torque(prepared, signals) else { return true };
    let friction = prepared.filtered(&prepared.friction_torque);
    let Some(left) = fit_residual(&columns, &friction, &rows) else { return true };
    let deviation = (dot(&left, &left, &rows) / rows_in(&rows).max(1) as f64).sqrt();
    grain <= POSITION_ERROR_SHARE * deviation
}

/// Deviation, behind the filter, of the torque that the errors of the position make through the inertia; `None` where the recording
/// shows no inertia.
pub(crate) fn position_error_torque(prepared: &Prepared, signals: &Signals) -> Option<f64> {
    let acceleration = prepared.filter.second_derivative_gain(signals.period);
    identified_inertia(prepared).map(|inertia| inertia.abs() * position_error(prepared, signals) * acceleration)
}
