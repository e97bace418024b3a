//! Errors of the formulas of effects that were found: where an effect is strong, what its formula leaves is no second effect
//! (Kennedy and O'Hagan 2001: a discrepancy of the model beside its parameters).

use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::hypotheses::channel::Channel;
use crate::diagnose::hypotheses::label::Label;
use crate::diagnose::hypotheses::unnamed::{cosines, rank_knots};
use crate::numerics::least_squares::{least_squares, weighted};

/// Error of a formula that is expected beforehand, root mean square, over the torque of the effect. The same as of a curve between two of
/// its knots in a simulation's law.
const EXPECTED_ERROR_SHARE: f64 = 0.1;

/// What an effect's torque is off by is a smooth function of one of these.
const CHANNELS: [Channel; 5] =
    [Channel::Speed, Channel::Position, Channel::Acceleration, Channel::DistanceSinceReversal, Channel::Time];

/// Terms of that function: a cosine series over the ranks of the channel, whose deviations fall with the square of the order, as of a
/// function with a bend but no jump.
const ORDER: usize = 4;

/// Filtered torque of each direction in which the formulas of effects may be off, at one standard deviation, with the coefficients that the
/// effects have beside each other and the base. None where these are undetermined.
pub(crate) fn formula_errors<'f>(
    workbench: &Workbench,
    effects: impl IntoIterator<Item = (&'f Label, &'f [f64])>,
) -> Vec<Vec<f64>> {
    let (prepared, base) = (workbench.prepared, workbench.base);
    let of_effects: Vec<Vec<Vec<f64>>> =
        effects.into_iter().map(|(label, shape)| workbench.raw_columns(&prepared.state, label, shape)).collect();
    let filtered = of_effects.iter().flat_map(|columns| prepared.filtered_all(columns));
    let columns: Vec<Vec<f64>> = base.columns.iter().cloned().chain(filtered).collect();
    let Some(coefficients) = least_squares(&columns, &base.target, &prepared.open_runs()) else { return Vec::new() };
    let mut begin = base.columns.len();
    let mut errors = Vec::new();
    for columns in of_effects {
        let end = begin + columns.len();
        errors.extend(errors_of(workbench, &weighted(&columns, &coefficients[begin..end])));
        begin = end;
    }
    errors
}

/// Those of one effect by its torque at every sample.
fn errors_of(workbench: &Workbench, torque: &[f64]) -> Vec<Vec<f64>> {
    let state = &workbench.prepared.state;
    // A cosine has half a unit of variance; each channel has its share.
    let orders: f64 = (1..=ORDER).map(|order| 0.5 * (order as f64).powi(-4)).sum();
    let scale = EXPECTED_ERROR_SHARE / (orders * CHANNELS.len() as f64).sqrt();
    let of_channel = |channel: Channel| {
        let series = channel.series(state).unwrap_or_default();
        let all = if series.is_empty() {
            Vec::new()
        } else {
            cosines(&series, &rank_knots(&series, &state.memory.at_rest), torque, ORDER)
        };
        let scaled = move |(order, mut column): (usize, Vec<f64>)| {
            column.iter_mut().for_each(|value| *value *= scale / (order * order) as f64);
            column
        };
        all.into_iter().enumerate().skip(1).map(scaled).collect::<Vec<_>>()
    };
    workbench.prepared.filtered_all(&CHANNELS.into_iter().flat_map(of_channel).collect::<Vec<_>>())
}
