//! A fit in torque space whose law gives way to the one by trajectory.

use crate::compile::host_model::HostModel;
use crate::error::Result;
use crate::fit::Outcome;
use crate::fit::model::{from_bytes, to_bytes};
use crate::fit::outcome::{CLOUD_POINTS, LawSummary, Representation, Score, Soundness, SplitScore, Trace};
use crate::fit::score::trace;
use crate::law::{Language, latex, render, significant};
use crate::recording::Recording;
use crate::rollout::{Instant, law};

use super::by_trajectory::ByTrajectory;

/// Significant digits of a figure in a sentence.
const DIGITS: usize = 3;

/// The outcome with the law by trajectory, scored on the torque that follows from its actuator. `in_torque_space` is the mean absolute
/// position error of the law that gives way, rad, where its joint could be simulated.
///
/// # Errors
/// `FRK-D020` where the image would be refused, and as [`trace`].
pub(super) fn adopt(
    mut outcome: Outcome,
    by: &ByTrajectory,
    recordings: &[Recording],
    tests: &[Recording],
    in_torque_space: Option<f64>,
) -> Result<Outcome> {
    let mut image = from_bytes(&outcome.image)?;
    image.model = (*by.model).clone();
    outcome.image = to_bytes(&image)?;
    let model: HostModel = from_bytes(&outcome.image)?.model;
    let score = |recording: &Recording| trace(&model, recording);
    outcome.train = recordings.iter().map(score).collect::<Result<_>>()?;
    outcome.tests = tests.iter().map(score).collect::<Result<_>>()?;
    outcome.train_score = Score::over(&outcome.train);
    outcome.train_split = SplitScore::over(&outcome.train);
    let symbols = ["v", "τ"];
    outcome.law = LawSummary {
        expression: render(&by.expression, Language::Unicode, &symbols),
        latex: latex(&by.expression, &symbols),
        nodes: by.expression.node_count(),
        rmse: outcome.train_score.rmse,
        front: Vec::new(),
        explored: outcome.law.explored,
    };
    let at = |velocity: f64| law(&model, &Instant { velocity, ..Instant::default() });
    outcome.law_curve.iter_mut().for_each(|point| point[1] = at(point[0]));
    // Friction and its band were those of another torque: of the constants found in torque space.
    outcome.cloud = cloud(&outcome.train);
    outcome.band.clear();
    outcome.candidates.iter_mut().for_each(|candidate| candidate.chosen = false);
    outcome.representation = Representation::Expression;
    let own = significant(by.mae, DIGITS);
    let other = in_torque_space.map_or("of which no joint can be simulated".to_owned(), |error| {
        format!("with {} rad", significant(error, DIGITS))
    });
    outcome.choice = format!(
        "by trajectory: mean absolute error of the simulated position {own} rad, against the law found in torque space, {other}"
    );
    outcome.parameters.clone_from(&by.parameters);
    outcome.sound = if by.converged {
        Soundness::Sound
    } else {
        Soundness::NotConverged("the fit by trajectory was still improving when its steps were used up".to_owned())
    };
    Ok(outcome)
}

/// Samples of the traces: velocity and recorded friction.
fn cloud(traces: &[Trace]) -> Vec<[f64; 2]> {
    let stride = traces.iter().map(|trace| trace.friction.len()).sum::<usize>().div_ceil(CLOUD_POINTS).max(1);
    let points = |trace: &Trace| -> Vec<[f64; 2]> {
        trace.velocity.iter().zip(&trace.friction).step_by(stride).map(|(v, f)| [*v, *f]).collect()
    };
    traces.iter().flat_map(points).collect()
}
