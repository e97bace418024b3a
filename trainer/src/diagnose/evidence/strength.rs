//! How strong a hidden torque is for a diagnosis: its non-centrality after base, filter and noise.

use crate::diagnose::comparison::base::Base;
use crate::diagnose::comparison::columns::BaseKind;
use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::evidence::score::Bench;
use crate::diagnose::noise::autoregression::{Noise, noise_features};
use crate::diagnose::preparation::rows::Lock;
use crate::numerics::least_squares::{dot, fit_residual, residual, rows_in};

/// Strength of a torque that a recording conceals.
#[derive(Clone, Debug, PartialEq)]
pub struct Strength {
    /// Non-centrality lambda: squared norm of the whitened torque that the base cannot absorb, on the open rows.
    pub lambda: f64,
    /// Root mean square of that torque over that of the noise, both behind the common filter.
    pub effect_to_noise: f64,
    /// What the base leaves at every working row once that torque is taken off: the least that a diagnosis can leave.
    pub rest_without: Vec<f64>,
    /// The noise behind the common filter at every working row.
    pub noise: Vec<f64>,
}

/// Strength of `torque` (one value a sample, unfiltered) against `noise` in the same recording. What the diagnosis
/// whitens with is the noise model of somebody who knows that torque: what base and torque together leave.
/// `None` where the recording cannot determine the base.
pub fn strength(
    comparison: &Comparison,
    torque: &[f64],
    noise: &[f64],
    base: BaseKind,
    lock: Lock,
) -> Option<Strength> {
    let mut prepared = comparison.prepare(lock);
    let base = Base::fit(&mut prepared, comparison, base)?;
    let runs = prepared.open_runs();
    let filtered = prepared.filtered(torque);
    let known: Vec<Vec<f64>> = base.columns.iter().cloned().chain([filtered.clone()]).collect();
    let model = Noise::fit(&fit_residual(&known, &base.target, &runs)?, &runs, &noise_features(&prepared));
    let white = |column: &[f64]| model.whitened(column, &runs);
    let columns: Vec<Vec<f64>> = base.columns.iter().map(|c| white(c)).collect();
    let whitened = Bench::new(columns, Vec::new(), white(&filtered), vec![runs.clone()]);
    let lambda = whitened.visible_energy(&whitened.target.clone())?;
    let bare: Vec<f64> = base.target.iter().zip(&filtered).map(|(t, f)| t - f).collect();
    let without = Bench::new(whitened.base().to_vec(), Vec::new(), white(&bare), whitened.blocks.clone());
    let rest_without = residual(&base.columns, &bare, &without.solve(&[])?);
    let plain = Bench::new(base.columns.clone(), Vec::new(), filtered.clone(), vec![runs.clone()]);
    let kept = plain.visible_energy(&filtered)?;
    let rows = rows_in(&runs);
    let noise = prepared.filtered(noise);
    let noise_rms = (dot(&noise, &noise, &runs) / rows as f64).sqrt();
    Some(Strength {
        lambda,
        effect_to_noise: (kept / rows as f64).sqrt() / noise_rms.max(f64::MIN_POSITIVE),
        rest_without,
        noise,
    })
}
