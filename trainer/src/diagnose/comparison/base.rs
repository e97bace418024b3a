//! The model already fitted, as columns: every parameter that may move when an effect is added, and the nuisances.

use crate::diagnose::comparison::columns::{BaseKind, filtered_columns, friction_basis, raw_columns};
use crate::diagnose::comparison::delay::position_error_energy;
use crate::diagnose::comparison::reference::{Comparison, tabulated_velocities};
use crate::diagnose::comparison::soft_sign::add_soft_sign;
use crate::diagnose::comparison::turn_over::TurnOver;
use crate::diagnose::preparation::states::{Prepared, channel_filter};
use crate::numerics::least_squares::{dot, fit_residual, least_squares, residual};
use crate::numerics::statistics::root_mean_square;
use crate::physics::EffectId;
use crate::samples::delay::LONGEST_SAMPLING_DELAY;

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
    pub reference_effects: Vec<EffectId>,
    /// Filtered torque of each direction in which a reference is not sure of itself, at one standard deviation.
    pub uncertainty: Vec<Vec<f64>>,
    /// What the base with a delay of the torque leaves at every working row.
    pub(crate) residual: Vec<f64>,
    /// Root mean square of what the formulas of a reference get wrong.
    pub formula_error: f64,
    /// Delay of the torque against the position that the fit found.
    pub(crate) delay: Delay,
}

impl Base {
    /// Error of a reference behind the filter, root mean square: of its formulas, or what it is not sure of.
    pub(crate) fn law_error(&self) -> f64 {
        let energy = |torque: &Vec<f64>| root_mean_square(torque).powi(2);
        self.formula_error.max(self.uncertainty.iter().map(energy).sum::<f64>().sqrt())
    }
}

/// What a delay of the torque against the position is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Delay {
    /// Short enough to be the sampling's own, in s: carried as a nuisance.
    OfSampling(f64),
    /// The answer of the drive to the encoder's grain explains as much.
    OfPositionError,
    /// An effect to be looked for.
    Open,
    /// There is none: a torque that follows from commands and motion has their time.
    None,
}

impl Base {
    /// Builds and fits the base, and writes the predicted torque and the friction curve into the states.
    /// `None` when the recording cannot determine it (no motion).
    pub fn fit(prepared: &mut Prepared, comparison: &Comparison, kind: BaseKind) -> Option<Self> {
        if let Some(turn_over) = TurnOver::of_recording(prepared, comparison, kind) {
            turn_over.turn(&mut prepared.state);
        }
        let raw = raw_columns(&prepared.state, comparison, kind);
        let names: Vec<&'static str> = raw.iter().map(|(name, _)| *name).collect();
        let target = prepared.filtered(&prepared.friction_torque);
        let runs = prepared.open_runs();
        let mut columns = filtered_columns(prepared, comparison, &raw);
        let coefficients = least_squares(&columns, &target, &runs)?;
        predict(prepared, comparison, kind, &raw, &coefficients);
        add_soft_sign(prepared, &mut columns, &target);
        let (left, delay) = if prepared.state.commanded.is_some() {
            (fit_residual(&columns, &target, &runs)?, Delay::None)
        } else {
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
                let in_step = fit_residual(&columns, &target, &runs)?;
                let explained = dot(&in_step, &in_step, &runs) - dot(&left, &left, &runs);
                if explained < position_error_energy(prepared, comparison) {
                    Delay::OfPositionError
                } else {
                    Delay::Open
                }
            };
            (left, delay)
        };
        let (reference_effects, uncertain_directions) = match &comparison.reference {
            Some(reference) => (reference.effects.clone(), &reference.uncertainty[..]),
            None => (Vec::new(), &[][..]),
        };
        let uncertainty = prepared.filtered_all(uncertain_directions);
        let formula_error = comparison.reference.as_ref().map_or(0.0, |reference| reference.formula_error);
        Some(Self { columns, names, target, reference_effects, uncertainty, residual: left, formula_error, delay })
    }
}

fn predict(
    prepared: &mut Prepared,
    comparison: &Comparison,
    kind: BaseKind,
    raw: &[(&'static str, Vec<f64>)],
    coefficients: &[f64],
) {
    let state = &mut prepared.state;
    // What was differentiated from the position without a filter would drown what is looked for in the rest.
    let smoothed =
        |known: &[f64]| channel_filter(prepared.filter.cut_off_hz, state.period).over(known, &state.segments);
    let known = comparison.known().torque.map(smoothed);
    let mut predicted = known.clone().unwrap_or_else(|| vec![0.0; state.len()]);
    for ((_, column), coefficient) in raw.iter().zip(coefficients) {
        predicted.iter_mut().zip(column).for_each(|(p, c)| *p += coefficient * c);
    }
    state.known = known;
    state.predicted = predicted;
    let top_speed = state.top_speed();
    state.base_friction = match &comparison.reference {
        Some(reference) if !reference.friction.is_empty() => reference.friction.clone(),
        _ => tabulated_velocities(1.2 * top_speed)
            .map(|velocity| {
                let basis = friction_basis(kind, velocity, (velocity / state.sign_velocity).tanh(), top_speed);
                (velocity, basis.iter().zip(coefficients).map(|(b, c)| b * c).sum())
            })
            .collect(),
    };
}
