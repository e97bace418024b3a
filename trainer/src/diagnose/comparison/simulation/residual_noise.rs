//! How much a law leaves of a recording, and how much of that is noise.

use crate::diagnose::comparison::base::Base;
use crate::diagnose::comparison::columns::BaseKind;
use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::comparison::simulation::InverseLaw;
use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::noise::autoregression::Noise;
use crate::diagnose::preparation::rows::Lock;
use crate::numerics::least_squares::fit_residual;
use crate::numerics::statistics::DEVIATION_PER_MEDIAN;
use crate::numerics::statistics::{quantile, root_mean_square};

/// What a law leaves of a recording, behind its filter.
pub(crate) struct ResidualNoise {
    /// Deviation of what the rows before do not tell of it: noise, and the errors of formulas where they jump.
    pub noise: f64,
    /// Root mean square of it beside the noise of most rows: the errors of formulas, and the colour of the noise.
    pub formula_error: f64,
}

/// What a law leaves of a recording once its Coulomb and viscous friction have moved.
pub(crate) fn residual_noise(recording: &Signals, law: &InverseLaw) -> Option<ResidualNoise> {
    let comparison = Comparison::with(recording.clone(), law.at(&recording.states()));
    let mut prepared = comparison.prepare(Lock::Nothing);
    let base = Base::fit(&mut prepared, &comparison, BaseKind::Reference)?;
    let runs = prepared.open_runs();
    let rest = fit_residual(&base.columns, &base.target, &runs)?;
    let model = Noise::fit(&rest, &runs, &[]);
    let noise = *model.deviation.first()?;
    let white = model.whitened(&rest, &runs);
    let of_most_rows = noise * DEVIATION_PER_MEDIAN * quantile(white.iter().map(|value| value.abs()), 0.5);
    let formula_error = (root_mean_square(&rest).powi(2) - of_most_rows.powi(2)).max(0.0).sqrt();
    Some(ResidualNoise { noise, formula_error })
}
