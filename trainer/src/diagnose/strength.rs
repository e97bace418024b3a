//! How strong a hidden torque is for a diagnosis: its non-centrality after base, filter and noise.

use super::base::{Base, BaseKind};
use super::evidence::Bench;
use super::noise::Noise;
use super::prepare::{Lock, Prepared};
use super::signals::Signals;

/// Strength of a torque that a recording conceals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strength {
    /// Non-centrality lambda: squared norm of the whitened torque that the base cannot absorb, on the open rows.
    pub lambda: f64,
    /// Root mean square of that torque over that of the noise, both behind the common filter.
    pub effect_to_noise: f64,
    /// Share of the torque's energy that the base absorbs.
    pub absorbed: f64,
}

/// Strength of `torque` (one value a sample, unfiltered) against `noise` in the same recording.
/// `None` where the recording cannot determine the base.
pub fn strength(signals: &Signals, torque: &[f64], noise: &[f64], base: BaseKind, lock: Lock) -> Option<Strength> {
    let mut prepared = Prepared::new(signals, lock);
    let base = Base::fit(&mut prepared, signals, base)?;
    let runs = prepared.open_runs();
    let model = Noise::fit(&prepared.filtered(noise), &runs, &[]);
    let order = model.autoregression.len();
    let trimmed: Vec<_> = runs.iter().map(|r| (r.start + order).min(r.end)..r.end).filter(|r| !r.is_empty()).collect();
    let white = |column: &[f64]| {
        let mut white = column.to_vec();
        model.whiten(&mut white, &runs);
        white
    };
    let filtered = prepared.filtered(torque);
    let columns: Vec<Vec<f64>> = base.columns.iter().map(|c| white(c)).collect();
    let whitened = Bench::new(columns, white(&filtered), vec![trimmed]);
    let lambda = whitened.visible_energy(&whitened.target.clone())?;
    let plain = Bench::new(base.columns.clone(), filtered.clone(), vec![runs.clone()]);
    let kept = plain.visible_energy(&filtered)?;
    let rows: usize = runs.iter().map(|run| run.len()).sum();
    let energy = super::linear::dot(&filtered, &filtered, &runs);
    Some(Strength {
        lambda,
        effect_to_noise: (kept / rows as f64).sqrt() / model.rms.max(f64::MIN_POSITIVE),
        absorbed: 1.0 - kept / energy.max(f64::MIN_POSITIVE),
    })
}
