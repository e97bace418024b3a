//! The proof: rows locked away from fitting and from the search are opened at the end. They count in the decision whether a finding
//! stands, so that the errors on them are not those of rows that decided nothing.

use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::proof::refit::{Refit, refit};
use crate::diagnose::search::accepted::{Accepted, others};
use crate::numerics::least_squares::{dot, residual, rows_in};
use statrs::distribution::{ContinuousCDF, StudentsT};
use std::ops::Range;

/// Error before and after on rows that no fit has seen.
#[derive(Clone, Debug, Default)]
pub struct Proof {
    /// Root mean square of what the refitted base leaves on locked rows.
    pub baseline_rmse: f64,
    /// Root mean square of what the improved model leaves.
    pub improved_rmse: f64,
    /// 95 % interval of the ratio improved / baseline, by block.
    pub ratio_ci95: [f64; 2],
    /// Gain of the whitened log-likelihood on locked rows in nats.
    pub gain_nats: f64,
    /// How much of the change that the open rows ask for the locked ones ask for as well, in standard deviations: standard normal
    /// where nothing is missing.
    pub locked_deviations: f64,
    /// The same deviations as they would be expected of an effect that is as large there as on the open rows.
    pub expected_deviations: f64,
    /// Share of that change's whitened energy that lies in the locked rows.
    pub locked_share: f64,
    /// Locked rows.
    pub rows: usize,
}

impl Proof {
    /// Whether the locked rows show by the interval of their ratio that the error fell.
    #[must_use]
    pub(crate) fn shows_gain(&self) -> bool {
        self.ratio_ci95[1] < 1.0
    }
}

/// Opens the locked blocks. `baseline` is the refit without effects. `None` where nothing was locked.
pub(crate) fn prove(workbench: &Workbench, baseline: &Refit, improved: &Refit) -> Option<Proof> {
    let blocks: Vec<&Vec<Range<usize>>> =
        workbench.prepared.blocks.iter().filter(|b| b.locked).map(|b| &b.runs).collect();
    let before = rest(workbench, baseline);
    let after = rest(workbench, improved);
    let energy = |series: &[f64], runs: &[Range<usize>]| dot(series, series, runs);
    let pairs: Vec<(f64, f64)> = blocks.iter().map(|runs| (energy(&before, runs), energy(&after, runs))).collect();
    let rows: usize = blocks.iter().map(|runs| rows_in(runs)).sum();
    if rows == 0 {
        return None;
    }
    let total = pairs.iter().fold((0.0, 0.0), |sum, pair| (sum.0 + pair.0, sum.1 + pair.1));
    let ratio = (total.1 / total.0).sqrt();
    let (open, locked) = (workbench.prepared.open_runs(), workbench.prepared.locked_runs());
    let white = |series: &[f64], runs: &[Range<usize>]| improved.noise.whitened(series, runs);
    let change: Vec<f64> = before.iter().zip(&after).map(|(b, a)| b - a).collect();
    let locked_change = white(&change, &locked);
    let locked_energy = energy(&locked_change, &locked);
    let change_energy = locked_energy + energy(&white(&change, &open), &open);
    let asked_for = dot(&white(&before, &locked), &locked_change, &locked);
    Some(Proof {
        baseline_rmse: (total.0 / rows as f64).sqrt(),
        improved_rmse: (total.1 / rows as f64).sqrt(),
        ratio_ci95: ratio_interval(&pairs, ratio),
        gain_nats: asked_for - 0.5 * locked_energy,
        locked_deviations: asked_for / locked_energy.sqrt().max(f64::MIN_POSITIVE),
        expected_deviations: locked_energy.sqrt(),
        locked_share: locked_energy / change_energy.max(f64::MIN_POSITIVE),
        rows,
    })
}

/// The proof of one effect given all the others; `all` is the refit of every one of them. `None` where nothing is locked.
pub(crate) fn prove_alone(workbench: &Workbench, accepted: &[Accepted], index: usize, all: &Refit) -> Option<Proof> {
    let others: Vec<Accepted> = others(accepted, index).cloned().collect();
    prove(workbench, &refit(workbench, &others)?, all)
}

/// What a refit leaves at every working row.
pub(crate) fn rest(workbench: &Workbench, refit: &Refit) -> Vec<f64> {
    let mut rest = residual(&workbench.base.columns, &workbench.base.target, &refit.base);
    for effect in &refit.effects {
        let torque = workbench.torque_of(effect);
        rest.iter_mut().zip(&torque).for_each(|(r, t)| *r -= t);
    }
    rest
}

/// Interval of a ratio of summed energies by the delta method over blocks.
pub(crate) fn ratio_interval(pairs: &[(f64, f64)], ratio: f64) -> [f64; 2] {
    let count = pairs.len() as f64;
    let Ok(student) = StudentsT::new(0.0, 1.0, count - 1.0) else { return [0.0, f64::INFINITY] };
    let student_95 = student.inverse_cdf(0.975);
    let mean = pairs.iter().map(|p| p.0).sum::<f64>() / count;
    // Linearised: d(log ratio^2) = (after - ratio^2 before) / (ratio^2 mean).
    let square = ratio * ratio;
    let variance =
        pairs.iter().map(|(b, a)| ((a - square * b) / (square * mean)).powi(2)).sum::<f64>() / (count * (count - 1.0));
    let half = 0.5 * student_95 * variance.sqrt();
    [ratio * (-half).exp(), ratio * half.exp()]
}
