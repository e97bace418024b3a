//! The model already fitted, as columns: every parameter that may move when an effect is added, and the nuisances.

use crate::diagnose::comparison::reference::tabulated_velocities;
use crate::diagnose::comparison::sign_width::{WIDE_SIGN, add_softness, fit_width, sharpness};
use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::position_error::grain_through_inertia;
use crate::diagnose::preparation::prepare::{Prepared, channel_filter};
use crate::numerics::least_squares::{dot, least_squares, left_by_fit, orthonormal, project_out, residual, rows_in};
use crate::physics::{EffectId, JointState};

/// Which static friction model the recording is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BaseKind {
    /// Symmetric Coulomb and viscous friction, refitted.
    CoulombViscous,
    /// A symmetric spline over speed with nine coefficients, refitted.
    Spline,
    /// The law of a fitted model or a simulation: its torque is given, its parameters may move by the given Jacobian.
    Reference,
}

/// A fitted base model: columns at the working rows behind the common filter.
#[derive(Clone, Debug)]
pub struct Base {
    /// Filtered columns, physical parameters first, then nuisances.
    pub columns: Vec<Vec<f64>>,
    /// Name of each physical parameter.
    pub names: Vec<&'static str>,
    /// Filtered target: recorded torque less the nominal rigid body or reference.
    pub target: Vec<f64>,
    /// Effects that a reference holds itself: the recording may ask for less of them.
    pub held: Vec<EffectId>,
    /// Filtered torque of each direction in which a reference is not sure of itself, at one standard deviation.
    pub doubt: Vec<Vec<f64>>,
    /// What the base with a delay of the torque leaves at every working row.
    pub(crate) residual: Vec<f64>,
    /// Root mean square of what the formulas of a reference get wrong.
    pub formula_error: f64,
    /// Delay of the torque against the position that the fit found.
    pub(crate) delay: Delay,
}

/// What a delay of the torque against the position is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Delay {
    /// Short enough to be the sampling's own, in s: carried as a nuisance.
    OfSampling(f64),
    /// The answer of the drive to the encoder's grain explains as much.
    OfGrain,
    /// An effect to be looked for.
    Open,
}

/// Coefficients of the spline base.
const SPLINE_KNOTS: usize = 9;

/// The friction columns of a base kind at one velocity.
/// `sign` is the smoothed sign at that velocity.
pub(crate) fn friction_basis(kind: BaseKind, velocity: f64, sign: f64, top_speed: f64) -> Vec<f64> {
    match kind {
        BaseKind::CoulombViscous => vec![sign, velocity],
        BaseKind::Spline => {
            speed_hats(velocity.abs() / top_speed.max(f64::MIN_POSITIVE), SPLINE_KNOTS).map(|hat| hat * sign).collect()
        }
        BaseKind::Reference => Vec::new(),
    }
}

/// Place of a knot over speed as a share of the top speed, by a square law: dense at low speed, where friction bends.
pub(crate) fn speed_knot(j: usize, knots: usize) -> f64 {
    (j as f64 / (knots - 1) as f64).powi(2)
}

/// Hat functions over speed as a share of the top speed, linear between knots, so exact for Coulomb and viscous friction. The last
/// two continue beyond the top speed, which only most samples stay below.
pub(crate) fn speed_hats(share: f64, knots: usize) -> impl Iterator<Item = f64> {
    let last = knots - 1;
    let knot = move |j: usize| speed_knot(j, knots);
    let after = ((share.sqrt() * last as f64) as usize + 1).min(last);
    let rise = (share - knot(after - 1)) / (knot(after) - knot(after - 1));
    (0..knots).map(move |j| match after.checked_sub(j) {
        Some(0) => rise,
        Some(1) => 1.0 - rise,
        _ => 0.0,
    })
}

impl Base {
    /// Builds and fits the base, and writes the predicted torque and the friction curve into the states.
    /// `None` when the recording cannot determine it (no motion).
    pub fn fit(prepared: &mut Prepared, signals: &Signals, kind: BaseKind) -> Option<Self> {
        fit_width(prepared, signals, kind);
        let raw = raw_columns(&prepared.state, signals, kind);
        let names: Vec<&'static str> = raw.iter().map(|(name, _)| *name).collect();
        let target = prepared.filtered(&prepared.friction_torque);
        let runs = prepared.open_runs();
        let mut columns = filtered_columns(prepared, signals, &raw);
        let coefficients = least_squares(&columns, &target, &runs)?;
        predict(prepared, signals, kind, &raw, &coefficients);
        add_softness(prepared, &mut columns, &target);
        let mut rate = prepared.state.rate_of(&prepared.state.predicted);
        rate.iter_mut().for_each(|value| *value = -*value);
        columns.push(prepared.filtered(&rate));
        let with_delay = least_squares(&columns, &target, &runs)?;
        let late = with_delay[columns.len() - 1];
        let left = residual(&columns, &target, &with_delay);
        let delay = if late.abs() <= LONGEST_SAMPLING_DELAY * prepared.state.period {
            Delay::OfSampling(late)
        } else {
            columns.pop();
            let in_step = left_by_fit(&columns, &target, &runs)?;
            let explained = dot(&in_step, &in_step, &runs) - dot(&left, &left, &runs);
            if explained < answer_to_grain(prepared, signals) { Delay::OfGrain } else { Delay::Open }
        };
        let (held, doubt) = match &signals.reference {
            Some(reference) => (reference.effects.clone(), &reference.doubt[..]),
            None => (Vec::new(), &[][..]),
        };
        let doubt = prepared.filtered_all(doubt);
        let formula_error = signals.reference.as_ref().map_or(0.0, |reference| reference.formula_error);
        Some(Self { columns, names, target, held, doubt, residual: left, formula_error, delay })
    }
}

/// The delay of the torque against the position (s) with which the base explains most of it; found by shifting the torque by whole
/// samples, up to [`LONGEST_DELAY_S`], and a parabola between them. 0 where a shift explains no more.
pub(crate) fn delay_by_shifting(mut prepared: Prepared, signals: &Signals, kind: BaseKind) -> f64 {
    fit_width(&mut prepared, signals, kind);
    let prepared = &prepared;
    let state = &prepared.state;
    let raw = raw_columns(state, signals, kind);
    let columns = filtered_columns(prepared, signals, &raw);
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
        explained > (1.0 - CLEARLY_LESS) * unshifted && explained > answer_to_grain(prepared, signals)
    };
    let Some(best) = best.filter(is_clear) else { return 0.0 };
    let [before, here, after] = [left[best - 1], left[best], left[best + 1]];
    let bend = before - 2.0 * here + after;
    let between = if bend > 0.0 { (0.5 * (before - after) / bend).clamp(-0.5, 0.5) } else { 0.0 };
    (best as f64 - longest as f64 + between) * state.period
}

/// Energy on open rows that a delay can explain by itself: the drive answers to the encoder's grain some samples later.
fn answer_to_grain(prepared: &Prepared, signals: &Signals) -> f64 {
    rows_in(&prepared.open_runs()) as f64 * grain_through_inertia(prepared, signals).map_or(0.0, |grain| grain * grain)
}

/// Samples of delay up to which it is the sampling's own: the drive holds its torque over a sample while the position is read at one
/// edge of it.
pub(crate) const LONGEST_SAMPLING_DELAY: f64 = 1.25;
/// Longest delay that is looked for, in s, but for two samples.
const LONGEST_DELAY_S: f64 = 0.03;
/// Share of what is left without a shift below which a shift counts.
const CLEARLY_LESS: f64 = 0.98;

/// The columns of the parameters and the nuisances behind the common filter.
pub(crate) fn filtered_columns(
    prepared: &Prepared,
    signals: &Signals,
    raw: &[(&'static str, Vec<f64>)],
) -> Vec<Vec<f64>> {
    let mut columns: Vec<Vec<f64>> = raw.iter().map(|(_, column)| prepared.filtered(column)).collect();
    columns.extend(nuisances(prepared));
    columns.push(sharpness(prepared));
    if let Some(reference) = &signals.reference {
        columns.extend(reference.left.iter().map(|left| prepared.filtered(left)));
    }
    columns
}

pub(crate) fn raw_columns(state: &JointState, signals: &Signals, kind: BaseKind) -> Vec<(&'static str, Vec<f64>)> {
    let top_speed = state.top_speed();
    let mut columns: Vec<(&'static str, Vec<f64>)> = Vec::new();
    let count = friction_basis(kind, 1.0, 1.0, top_speed).len();
    let names = match kind {
        BaseKind::CoulombViscous => &["coulomb_torque", "viscous_coefficient"][..],
        _ => &["friction_knot"; SPLINE_KNOTS][..],
    };
    for (j, name) in names.iter().enumerate().take(count) {
        columns.push((name, state.map(|i| friction_basis(kind, state.velocity[i], state.sign[i], top_speed)[j])));
    }
    if let Some(reference) = &signals.reference {
        columns.extend(reference.jacobian.iter().cloned());
    } else if signals.rigid_body.is_none() {
        // No rigid body is given: its inertia is identified together with friction.
        columns.push(("inertia", state.acceleration.clone()));
    }
    columns
}

/// Change of the smoothed sign and of the acceleration with the width of the filter: they carry the differentiation bias.
pub(crate) fn nuisances(prepared: &Prepared) -> Vec<Vec<f64>> {
    let state = &prepared.state;
    let narrow_sign = state.averaged_sign(&prepared.narrow_velocity, state.sign_velocity);
    let sign = state.map(|i| narrow_sign[i] - state.sign[i]);
    let acceleration = state.map(|i| prepared.narrow_acceleration[i] - state.acceleration[i]);
    // The smoothed sign stands for a jump: its width is a nuisance too.
    let wide_sign = state.averaged_sign(&state.velocity, WIDE_SIGN * state.sign_velocity);
    let width = state.map(|i| wide_sign[i] - state.sign[i]);
    vec![prepared.filtered(&sign), prepared.filtered(&acceleration), prepared.filtered(&width)]
}

fn predict(
    prepared: &mut Prepared,
    signals: &Signals,
    kind: BaseKind,
    raw: &[(&'static str, Vec<f64>)],
    coefficients: &[f64],
) {
    let state = &mut prepared.state;
    // What was differentiated from the position without a filter would drown what is looked for in the rest.
    let mut predicted = match signals.known_torque() {
        Some(known) => channel_filter(prepared.filter.cut_off_hz, state.period).over(known, &state.segments),
        None => vec![0.0; state.len()],
    };
    for ((_, column), coefficient) in raw.iter().zip(coefficients) {
        predicted.iter_mut().zip(column).for_each(|(p, c)| *p += coefficient * c);
    }
    state.predicted = predicted;
    let top_speed = state.top_speed();
    state.base_friction = match &signals.reference {
        Some(reference) if !reference.friction.is_empty() => reference.friction.clone(),
        _ => tabulated_velocities(1.2 * top_speed)
            .map(|velocity| {
                let basis = friction_basis(kind, velocity, (velocity / state.sign_velocity).tanh(), top_speed);
                (velocity, basis.iter().zip(coefficients).map(|(b, c)| b * c).sum())
            })
            .collect(),
    };
}

#[cfg(test)]
mod tests {
    use super::*;
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
            let signals = Signals::without_gap(period, time.clone(), position, late);
            let delay = delay_by_shifting(Prepared::new(&signals, Lock::Nothing), &signals, BaseKind::CoulombViscous);
            assert!((delay / period - samples).abs() < 0.2, "{} of {samples} samples", delay / period);
        }
    }

    #[test]
    fn the_spline_holds_coulomb_and_viscous_friction_exactly() {
        let (knots, top_speed) = (9, 3.0);
        let at_knots: Vec<f64> = (0..knots).map(|j| 2.0 + 1.2 * top_speed * (j as f64 / 8.0).powi(2)).collect();
        for speed in [0.0, 1e-9, 0.02, 0.4, 0.75, 2.9, 3.0, 3.3, 9.0] {
            let torque: f64 = speed_hats(speed / top_speed, knots).zip(&at_knots).map(|(hat, f)| hat * f).sum();
            assert!((torque - (2.0 + 1.2 * speed)).abs() < 1e-9, "{torque} at {speed}");
        }
    }
}
