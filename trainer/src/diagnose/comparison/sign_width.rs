//! How sharply friction turns over with the direction: the width of the smoothed sign, and what of it stays unknown.

use crate::diagnose::comparison::columns::{BaseKind, SOFT_SIGN_WIDTH_RATIO, filtered_columns, raw_columns};
use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::preparation::states::Prepared;
use crate::numerics::least_squares::{dot, fit_residual, least_squares};
use crate::numerics::pattern_search::{Movable, climb};

/// Widths of the smoothed sign that are tried, over the least: factors of two, from the nearest of which the width is
/// fitted.
const SIGN_WIDTH_RATIOS: [f64; 4] = [2.0, 4.0, 8.0, 16.0];
/// Upper bound of the fitted width over the least. Chosen by judgement: twice the widest that is tried; a joint whose
/// friction turns over more softly has no Coulomb friction.
const WIDEST_SIGN_RATIO: f64 = 30.0;

/// Energy that the base leaves with a wider sign over that with the least, below which the wider one is the joint's
/// own. Held by `presliding_and_the_stribeck_effect_are_no_soft_sign`: higher lets either pass for a softer sign.
const SOFT_SIGN_ENERGY_RATIO: f64 = 0.01;
/// The same below which the width is fitted. A limit of the computing time: ten times the ratio that decides, for what
/// fitting gains between two widths of the grid.
const REFINED_SIGN_ENERGY_RATIO: f64 = 0.1;

/// Torque of a softer sign over the friction at low speed, up to which it is friction's own softness: one, with half of
/// it for the error of the estimate. Chosen by judgement: lowered from 2; higher takes up effects at low speed.
const SOFT_SIGN_TORQUE_RATIO: f64 = 1.5;

/// Widens the smoothed sign where friction turns over so softly that next to nothing else is wrong with the base.
pub(crate) fn fit_sign_width(prepared: &mut Prepared, comparison: &Comparison, kind: BaseKind) {
    if kind == BaseKind::Reference {
        return;
    }
    let least = prepared.state.sign_velocity;
    let (target, runs) = (prepared.filtered(&prepared.friction_torque), prepared.open_runs());
    let mut left_at = |over_least: f64| {
        prepared.state.turn_over_within(over_least * least);
        let columns = filtered_columns(prepared, comparison, &raw_columns(&prepared.state, comparison, kind));
        fit_residual(&columns, &target, &runs).map_or(f64::INFINITY, |left| dot(&left, &left, &runs))
    };
    let unwidened = left_at(1.0);
    let tried = SIGN_WIDTH_RATIOS.map(|width| (width, left_at(width)));
    let mut own = 1.0;
    if let Some((nearest, left)) = tried.into_iter().min_by(|a, b| a.1.total_cmp(&b.1))
        && left < REFINED_SIGN_ENERGY_RATIO * unwidened
    {
        let free = Movable { index: 0, step: 0.5, low: 0.0, high: WIDEST_SIGN_RATIO.ln() };
        let width = climb(&[f64::ln(nearest)], &[free], |width| Some(-left_at(width[0].exp())))[0].exp();
        if left_at(width) < SOFT_SIGN_ENERGY_RATIO * unwidened {
            own = width;
        }
    }
    prepared.state.turn_over_within(own * least);
}

/// Friction may turn over softly, and its torque may be that of an instant instead of a whole sample: the softer sign at the samples is
/// a nuisance beside the given columns, but where it takes more torque than friction has there or the opposite, and stands for
/// something else.
pub(crate) fn add_soft_sign(prepared: &Prepared, columns: &mut Vec<Vec<f64>>, target: &[f64]) {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::measurement::signals::Signals;
    use crate::diagnose::preparation::rows::Lock;
    use std::f64::consts::TAU;

    /// A body of 0.5 kg m2 with friction by the velocity and by the position since the last reversal.
    fn moving(friction: impl Fn(f64, f64) -> f64) -> Signals {
        let time: Vec<f64> = (0..20_000).map(|i| 1e-3 * f64::from(i)).collect();
        let position: Vec<f64> = time.iter().map(|t| (TAU * 0.7 * t).sin() + 0.4 * (TAU * 0.31 * t).sin()).collect();
        let (fast, slow) = (TAU * 0.7, TAU * 0.31);
        let velocity: Vec<f64> = time.iter().map(|t| fast * (fast * t).cos() + 0.4 * slow * (slow * t).cos()).collect();
        let mut since = 0.0;
        let torque = |i: usize| {
            since = if i > 0 && velocity[i] * velocity[i - 1] < 0.0 { position[i] } else { since };
            let t = time[i];
            let acceleration = -fast * fast * (fast * t).sin() - 0.4 * slow * slow * (slow * t).sin();
            0.5 * acceleration + friction(velocity[i], position[i] - since) + 1e-4 * (7919.0 * t * t).sin()
        };
        let torque = (0..time.len()).map(torque).collect();
        Signals::without_gap(1e-3, time, position, torque)
    }

    fn widened(signals: Signals) -> (f64, f64) {
        let comparison = Comparison::from(signals);
        let mut prepared = comparison.prepare(Lock::Nothing);
        let least = prepared.state.sign_velocity;
        fit_sign_width(&mut prepared, &comparison, BaseKind::CoulombViscous);
        (least, prepared.state.sign_velocity)
    }

    #[test]
    fn the_width_of_a_soft_sign_is_found() {
        let (_, width) = widened(moving(|velocity, _| 2.0 * (velocity / 0.04).tanh() + 0.3 * velocity));
        assert!((width / 0.04 - 1.0).abs() < 0.1, "{width}");
    }

    #[test]
    fn presliding_and_the_stribeck_effect_are_no_soft_sign() {
        let presliding = moving(|velocity, travelled| 2.0 * (travelled / 0.02).clamp(-1.0, 1.0) + 0.3 * velocity);
        let stribeck = moving(|velocity, _| (2.0 + (-(velocity / 0.2).powi(2)).exp()) * (velocity / 1e-3).tanh());
        for signals in [presliding, stribeck] {
            let (least, width) = widened(signals);
            assert_eq!(width, least);
        }
    }
}
