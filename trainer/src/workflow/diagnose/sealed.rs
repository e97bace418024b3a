//! The figures that are told of an improved model: the written image against what the recording was compared with, as
//! `trainer predict` sees them, on rows that decided nothing.

use crate::diagnose::answer::sealed::{Residuals, SealedScore};
use crate::diagnose::measurement::join::follow_s;
use crate::fit::HostModel;
use crate::fit::score::residual;
use crate::recording::{Quantity, Recording};
use serde_json::{Value, json};

/// Scores two models on stretches (from, to; s) of recordings that follow each other. `None` where there are none, or a model cannot
/// predict the recordings.
pub(super) fn sealed_score(
    when_s: &[[f64; 2]],
    recordings: &[Recording],
    period_s: f64,
    [before, after]: [&HostModel; 2],
) -> Option<SealedScore> {
    if when_s.is_empty() {
        return None;
    }
    let mut all = Residuals { time: Vec::new(), before: Vec::new(), after: Vec::new() };
    for recording in recordings {
        let time = recording.values(Quantity::Time)?;
        let shift_s = follow_s(&all.time, time, period_s);
        all.before.extend(residual(before, recording).ok()?);
        all.after.extend(residual(after, recording).ok()?);
        all.time.extend(time.iter().map(|time| time + shift_s));
    }
    SealedScore::of(&all, when_s)
}

/// As the JSON of a diagnosis carries it.
pub(super) fn to_json(score: &SealedScore) -> Value {
    json!({
        "when_s": score.when_s,
        "n": score.n,
        "before": { "rmse": score.before_rmse },
        "after": { "rmse": score.after_rmse },
        "ratio": score.ratio,
        "ci95": score.ratio_ci95,
    })
}
