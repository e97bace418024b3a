//! A delay of the torque against the position, found by shifting the torque.

use crate::diagnose::comparison::columns::{BaseKind, filtered_columns, raw_columns};
use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::comparison::turn_over::TurnOver;
use crate::diagnose::preparation::position_error::position_error_torque;
use crate::diagnose::preparation::states::Prepared;
use crate::numerics::least_squares::{dot, orthonormal, project_out, rows_in};

/// Longest delay that is looked for, s, but at least two samples. Chosen by judgement: several periods of a field bus;
/// longer may fit one swing of a fast motion to the next.
const LONGEST_DELAY_S: f64 = 0.03;
/// Energy left with a shift over that without, below which the shift counts. Chosen by judgement: nearer to one the
/// errors of the base shift the torque, smaller leaves a delay in a noisy recording.
const SHIFTED_ERROR_RATIO: f64 = 0.98;

/// The delay of the torque against the position (s) with which the base explains most of it; found by shifting the torque by whole
/// samples, up to [`LONGEST_DELAY_S`], and a parabola between them. 0 where a shift explains no more. Friction that turns over before the velocity
/// may pass for an early torque, and an early torque for such friction: what leaves less of the torque is taken.
pub(crate) fn delay_by_shifting(prepared: Prepared, comparison: &Comparison, kind: BaseKind) -> f64 {
    let leading = TurnOver::of_recording(&prepared, comparison, kind);
    let with = |turn_over: Option<TurnOver>| {
        let mut prepared = prepared.clone();
        if let Some(turn_over) = turn_over {
            turn_over.turn(&mut prepared.state);
        }
        shift(&prepared, comparison, kind)
    };
    let leads = leading.is_some_and(|found| found.lead_s > 0.0);
    let in_step = leading.map(|found| TurnOver { lead_s: 0.0, ..found });
    let shifts = [Some(with(leading)), leads.then(|| with(in_step))];
    shifts.into_iter().flatten().min_by(|a, b| a.left.total_cmp(&b.left)).map_or(0.0, |shift| shift.delay_s)
}

/// A shift of the torque, and the energy that the base leaves with it.
struct Shift {
    delay_s: f64,
    left: f64,
}

fn shift(prepared: &Prepared, comparison: &Comparison, kind: BaseKind) -> Shift {
    let state = &prepared.state;
    let raw = raw_columns(state, comparison, kind);
    let columns = filtered_columns(prepared, comparison, &raw);
    let runs = prepared.open_runs();
    let directions = orthonormal(&columns, &runs);
    let torque = prepared.filter.over(&prepared.torque, &state.segments);
    let known: Vec<f64> = prepared.torque.iter().zip(&prepared.friction_torque).map(|(t, f)| t - f).collect();
    let known = prepared.filtered(&known);
    let longest = ((LONGEST_DELAY_S / state.period) as isize).max(2);
    let left_at = |shift: isize| {
        let shifted =
            |(&row, known): (&usize, &f64)| torque[row.saturating_add_signed(shift).min(torque.len() - 1)] - known;
        let mut left: Vec<f64> = prepared.rows.iter().zip(&known).map(shifted).collect();
        project_out(&mut left, &directions, &runs);
        dot(&left, &left, &runs)
    };
    let left: Vec<f64> = (-longest..=longest).map(left_at).collect();
    let best = (1..left.len() - 1).min_by(|&a, &b| left[a].total_cmp(&left[b]));
    let unshifted = left[longest as usize];
    let is_clear = |best: &usize| {
        let explained = unshifted - left[*best];
        explained > (1.0 - SHIFTED_ERROR_RATIO) * unshifted && explained > position_error_energy(prepared, comparison)
    };
    let Some(best) = best.filter(is_clear) else { return Shift { delay_s: 0.0, left: unshifted } };
    let [before, here, after] = [left[best - 1], left[best], left[best + 1]];
    let bend = before - 2.0 * here + after;
    let between = if bend > 0.0 { (0.5 * (before - after) / bend).clamp(-0.5, 0.5) } else { 0.0 };
    Shift { delay_s: (best as f64 - longest as f64 + between) * state.period, left: here }
}

/// Energy on open rows that a delay can explain by itself: the drive answers to the encoder's grain some samples later.
pub(crate) fn position_error_energy(prepared: &Prepared, comparison: &Comparison) -> f64 {
    rows_in(&prepared.open_runs()) as f64
        * position_error_torque(prepared, &comparison.signals).map_or(0.0, |grain| grain * grain)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::measurement::signals::Signals;
    use crate::diagnose::preparation::rows::Lock;

    /// A body of 0.5 kg m2 with Coulomb and viscous friction, whose torque is recorded late by some samples of 2 ms.
    #[test]
    fn a_late_torque_is_found_by_shifting_it() {
        let period = 0.002;
        let time: Vec<f64> = (0..15_000).map(|i| period * f64::from(i)).collect();
        let tones = [(0.8, 1.3), (0.3, 3.7), (0.1, 9.1)];
        let sum = |t: f64, of: fn(f64, f64, f64) -> f64| tones.iter().map(|(a, w)| of(*a, *w, t)).sum::<f64>();
        let torque = |t: f64| {
            let velocity = sum(t, |a, w, t| a * w * (w * t).cos());
            2.0 * (velocity / 0.01).tanh() + 1.2 * velocity + 0.5 * sum(t, |a, w, t| -a * w * w * (w * t).sin())
        };
        for samples in [0.0, 1.0, 5.0, -7.5] {
            let position = time.iter().map(|t| sum(*t, |a, w, t| a * (w * t).sin())).collect();
            let late = time.iter().map(|t| torque(t - samples * period)).collect();
            let comparison = Comparison::from(Signals::without_gap(period, time.clone(), position, late));
            let delay = delay_by_shifting(comparison.prepare(Lock::Nothing), &comparison, BaseKind::CoulombViscous);
            assert!((delay / period - samples).abs() < 0.2, "{} of {samples} samples", delay / period);
        }
    }
}
