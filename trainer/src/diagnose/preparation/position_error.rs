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
/// Torque by the noise of the position over the friction, root mean squares, from which on it biases what is found: a fifth of the least effect that is
/// named, so that its power is a twenty-fifth of that effect's.
pub(crate) const BIASING_SHARE: f64 = 0.001;
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

/// Whether such a noise of the position biases what is found: a regressor with a share of noise in its power is underestimated by that share (Fuller
/// 1987), and what the inertia's is worth would pass for an effect.
pub(crate) fn noise_biases(prepared: &Prepared, noise: f64) -> bool {
    let Some(inertia) = identified_inertia(prepared).filter(|_| noise > 0.0) else { return false };
    let of_noise = noise * prepared.filter.second_derivative_gain(prepared.state.period);
    let acceleration = prepared.filtered(&prepared.state.acceleration);
    let friction = prepared.filtered(&prepared.friction_torque);
    let friction: Vec<f64> = friction.iter().zip(&acceleration).map(|(torque, a)| torque - inertia * a).collect();
    // Of the acceleration's power; the inertia is underestimated by it already.
    let acceleration = root_mean_square(&acceleration);
    let share = of_noise.powi(2) / acceleration.powi(2);
    let bias = inertia.abs() * acceleration * share / (1.0 - share).sqrt();
    share >= 1.0 || bias > BIASING_SHARE * root_mean_square(&friction)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actuator::{Command, Commanded, Kind, Partial};
    use crate::diagnose::preparation::rows::Lock;
    use crate::diagnose::preparation::states::Known;
    use crate::numerics::random::normal;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;

    /// Cut-off of a swing of 0.5 kg m2 against 2 N m of friction, whose position is recorded with this noise, rad.
    fn cut_off_hz(noise: f64, is_commanded: bool) -> f64 {
        let mut random = ChaCha8Rng::seed_from_u64(3);
        let time: Vec<f64> = (0..20_000).map(|i| 0.002 * f64::from(i)).collect();
        let position = time.iter().map(|t| (4.0 * t).sin() + noise * normal(&mut random)).collect();
        let torque = time.iter().map(|t| -8.0 * (4.0 * t).sin() + 2.0 * (4.0 * t).cos().signum()).collect();
        let mut signals = Signals::without_gap(0.002, time, position, torque);
        let actuator = Partial::of(Kind::Pd, &std::collections::BTreeMap::new()).actuator;
        signals.commanded = is_commanded.then(|| Commanded::of(vec![Command::default(); 20_000], actuator));
        Prepared::new(&signals, Known::of(&signals), Lock::Nothing).filter.cut_off_hz
    }

    #[test]
    fn the_filter_of_a_commanded_joint_is_narrow_enough_for_the_noise_of_its_position() {
        let without = cut_off_hz(0.0, true);
        let widths = [1e-5, 1e-4, 1e-3].map(|noise| cut_off_hz(noise, true));
        assert!(widths[0] <= without && widths[1] < widths[0] && widths[2] < widths[1], "{without} {widths:?}");
        assert_eq!(cut_off_hz(1e-4, false), without, "noise of a torque column is its own");
    }
}
