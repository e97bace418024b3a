//! The figures that are told of an improved model: the written image against what the recording was compared with, as
//! `trainer predict` sees them, on rows that decided nothing.

use crate::commands::measurement::motion;
use crate::diagnose::answer::outcome::Diagnosis;
use crate::diagnose::answer::sealed::{Residuals, SealedScore};
use crate::error::Result;
use crate::fit::HostModel;
use crate::fit::predict::{every_row, predict};
use crate::joint::Joint;
use crate::recording::Recording;
use serde_json::{Value, json};

/// Scores two models on the sealed stretches of recordings that follow each other. `None` where nothing is sealed, or a model cannot
/// predict the recordings.
pub(super) fn sealed_score(
    diagnosis: &Diagnosis,
    recordings: &[Recording],
    joint: &Joint,
    period_s: f64,
    [before, after]: [&HostModel; 2],
) -> Option<SealedScore> {
    if diagnosis.sealed_s.is_empty() {
        return None;
    }
    let mut all = Residuals { time: Vec::new(), before: Vec::new(), after: Vec::new() };
    for recording in recordings {
        let (recording, _) = motion(recording.clone(), joint).ok()?;
        let (time, left) = residual(before, &recording).ok()?;
        let (_, left_after) = residual(after, &recording).ok()?;
        // Recordings whose clock begins anew follow each other at once, as they do in the diagnosis.
        let end = all.time.last().copied().unwrap_or(f64::NEG_INFINITY);
        let begin = *time.first()?;
        let shift = if begin > end { 0.0 } else { end + period_s - begin };
        all.time.extend(time.iter().map(|time| time + shift));
        all.before.extend(left);
        all.after.extend(left_after);
    }
    SealedScore::of(&all, &diagnosis.sealed_s)
}

/// Time of every row, s, and recorded less predicted actuator.
fn residual(model: &HostModel, recording: &Recording) -> Result<(Vec<f64>, Vec<f64>)> {
    let samples = every_row(model, recording)?;
    let predicted = predict(model, &samples)?.total();
    let recorded = samples.recorded.as_deref().unwrap_or_default();
    let left = recorded.iter().zip(predicted).map(|(recorded, predicted)| recorded - predicted).collect();
    Ok((samples.time, left))
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
