//! The whole way from recordings of commands to an image.

use super::adopt::adopt;
use super::as_torque::AsTorque;
use super::by_trajectory::by_trajectory;
use super::friction::Terms;
use super::identified::Identified;
use super::known_torque::{Load, known_torque, without_payload};
use super::torque_space::identify;
use crate::error::Result;
use crate::fit::model::from_bytes;
use crate::fit::{Options, Outcome, Progress, ProgressCallback, Stage, fit};
use crate::joint::Joint;
use crate::recording::Recording;
use crate::rollout::{Score, default_window_s, score_of_image};

/// A recording simulated with the image.
#[derive(Clone, Debug)]
pub struct Simulated {
    /// File name of the recording.
    pub label: String,
    /// How far the simulated joint comes off; none where it cannot be simulated.
    pub score: Option<Score>,
}

/// A fit of a joint that reports no torque.
#[derive(Clone, Debug)]
pub struct ServoFit {
    /// The fit of the torque that follows from the commands; its image is that of the joint without payload.
    pub outcome: Outcome,
    /// What was identified of the actuator.
    pub identified: Identified,
    /// The recordings that were fitted, simulated with the image.
    pub train: Vec<Simulated>,
    /// Those that were not.
    pub tests: Vec<Simulated>,
}

/// Fits recordings of commands: in torque space and by trajectory, of which the law is kept whose simulated joint comes closer to them.
///
/// # Errors
/// As [`fit()`], `FRK-D009` and `FRK-D014` for columns and constants that are missing, `FRK-N004` where the joint cannot be simulated, `FRK-N005`
/// for a constant that the recordings do not determine.
pub fn fit_servo(
    recordings: &[Recording],
    tests: &[Recording],
    joint: &Joint,
    options: &Options,
    progress: ProgressCallback<'_>,
) -> Result<ServoFit> {
    let tell = |stage| progress(&Progress { stage, steps: 0, rmse: None });
    tell(Stage::Identifying);
    let mut identified = identify(recordings, joint)?;
    let way = AsTorque::of(recordings, joint, &identified);
    let outcome = fit(&way.known(recordings)?, &way.known(tests)?, &way.bare, options, progress)?;
    let mut outcome = without_payload(outcome, &identified, way.reference)?;
    tell(Stage::Simulating);
    let mut train = simulated(&outcome, recordings, joint, &identified)?;
    let scores: Option<Vec<Score>> = train.iter().map(|simulated| simulated.score).collect();
    let in_torque_space = scores.map(|scores| Score::over(&scores).mae);
    let start = from_bytes(&outcome.image)?.model;
    let by = match Terms::of(options.form) {
        Some(terms) => {
            tell(Stage::FittingMotion);
            Some(by_trajectory(recordings, joint, &identified, &start, terms)?)
        }
        None => None,
    };
    match by {
        Some(by) if in_torque_space.is_none_or(|error| by.mae < error) => {
            // Scored with all of the payload taken off, as the model is that of the joint alone.
            let known = |of: &[Recording]| {
                let torque = |recording| known_torque(recording, joint, &by.identified, 0.0, Load::OfActuator);
                of.iter().map(torque).collect::<Result<Vec<_>>>()
            };
            outcome = adopt(outcome, &by, &known(recordings)?, &known(tests)?, in_torque_space)?;
            identified = by.identified;
            train = simulated(&outcome, recordings, joint, &identified)?;
        }
        Some(by) => {
            let (own, other) = (by.mae, in_torque_space.unwrap_or(f64::INFINITY));
            outcome.remarks.push(format!(
                "By trajectory nothing better was found: it leaves {own:.4} rad of the position, the law in torque space {other:.4} rad."
            ));
        }
        None => outcome
            .remarks
            .push("A law of this form is not fitted by trajectory: it is that of torque space.".to_owned()),
    }
    tell(Stage::Simulating);
    let tests = simulated(&outcome, tests, joint, &identified)?;
    Ok(ServoFit { outcome, identified, train, tests })
}

fn simulated(
    outcome: &Outcome,
    recordings: &[Recording],
    joint: &Joint,
    identified: &Identified,
) -> Result<Vec<Simulated>> {
    let model = from_bytes(&outcome.image)?.model;
    let known = identified.joint(joint);
    let window_s = default_window_s(joint.actuator.kind);
    let of = |recording: &Recording| {
        let score = score_of_image(&model, recording, &known, window_s).ok();
        Simulated { label: recording.label.clone(), score }
    };
    Ok(recordings.iter().map(of).collect())
}
