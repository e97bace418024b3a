//! What a refit, or a law before its parameters moved, leaves of the recorded torque.

use crate::diagnose::answer::outcome::{Given, Score};
use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::proof::locked_rows::rest;
use crate::diagnose::proof::refit::Refit;

/// The score of a refit over all working rows.
pub(crate) fn score(workbench: &Workbench, refit: &Refit) -> Score {
    let rest = rest(workbench, refit);
    let torque = workbench.prepared.filtered(&workbench.prepared.torque);
    let count = rest.len() as f64;
    let mean = torque.iter().sum::<f64>() / count;
    let energy: f64 = rest.iter().map(|r| r * r).sum();
    let spread: f64 = torque.iter().map(|t| (t - mean).powi(2)).sum();
    Score { rmse: (energy / count).sqrt(), r2: 1.0 - energy / spread.max(f64::MIN_POSITIVE) }
}

/// The reference before its parameters moved; differentiation bias and the sampling's delay are none of its errors.
pub(crate) fn score_as_given(workbench: &Workbench, baseline: &Refit) -> Given {
    let score = score(workbench, &baseline.with_base_as_given(workbench));
    Given { score, holds: workbench.base.reference_effects.clone() }
}
