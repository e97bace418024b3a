//! How much a law leaves of a recording, and how much of that is noise.

use super::super::base::{Base, BaseKind};
use super::super::blocks::Lock;
use super::super::linear::left_by_fit;
use super::super::noise::Noise;
use super::super::prepare::{DEVIATION_PER_MEDIAN, Prepared};
use super::super::signals::Signals;
use super::InverseLaw;
use crate::statistics::{quantile, root_mean_square};

/// What a law leaves of a recording, behind its filter.
pub(super) struct Rest {
    /// Deviation of what the rows before do not tell of it: noise, and the errors of formulas where they jump.
    pub noise: f64,
    /// Root mean square of it beside the noise of most rows: the errors of formulas, and the colour of the noise.
    pub formula_error: f64,
}

/// What a law leaves of a recording once its Coulomb and viscous friction have moved.
pub(super) fn rest_of(recording: &Signals, law: &InverseLaw) -> Option<Rest> {
    let mut signals = recording.clone();
    signals.compare_with(law.at(&recording.states()));
    let mut prepared = Prepared::new(&signals, Lock::Nothing);
    let base = Base::fit(&mut prepared, &signals, BaseKind::Reference)?;
    let runs = prepared.open_runs();
    let rest = left_by_fit(&base.columns, &base.target, &runs)?;
    let model = Noise::fit(&rest, &runs, &[]);
    let noise = *model.deviation.first()?;
    let white = model.whitened(&rest, &runs);
    let of_most_rows = noise * DEVIATION_PER_MEDIAN * quantile(white.iter().map(|value| value.abs()), 0.5);
    let formula_error = (root_mean_square(&rest).powi(2) - of_most_rows.powi(2)).max(0.0).sqrt();
    Some(Rest { noise, formula_error })
}
