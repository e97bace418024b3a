//! How far the joint comes off that is simulated with the fitted image under what was recorded.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::fit::Outcome;
use crate::fit::model;
use crate::joint::Joint;
use crate::recording::{Axis, Recording};
use crate::rollout::{default_window_s, score_of_image};
use crate::servo::{ServoFit, Simulated};

/// Simulated recordings.
#[derive(Clone, Debug)]
pub(super) struct SimulatedMotions {
    unit: &'static str,
    /// After this time each simulation is put back to the recorded state, s; `None` where it never is.
    window_s: Option<f64>,
    train: Vec<Simulated>,
    tests: Vec<Simulated>,
}

impl SimulatedMotions {
    /// Of a joint that reports no torque: under the recorded commands.
    pub(super) fn of_servo(fit: &ServoFit, joint: &Joint) -> Self {
        Self {
            unit: "rad",
            window_s: default_window_s(joint.actuator.kind),
            train: fit.train.clone(),
            tests: fit.tests.clone(),
        }
    }

    /// Under the recorded torque; `None` where the image knows no inertia or a recording no torque.
    pub(super) fn under_torque(
        outcome: &Outcome,
        recordings: &[Recording],
        tests: &[Recording],
        joint: &Joint,
    ) -> Option<Self> {
        let image = model::from_bytes(&outcome.image).ok()?;
        let window_s = default_window_s(joint.actuator.kind);
        let simulated = |recording: &Recording| {
            let score = score_of_image(&image.model, recording, joint, window_s).ok();
            Simulated { label: recording.label.clone(), score }
        };
        let unit = if recordings.first()?.axis == Axis::Rotary { "rad" } else { "m" };
        let train: Vec<Simulated> = recordings.iter().map(simulated).collect();
        let any = train.iter().any(|simulated| simulated.score.is_some());
        any.then(|| Self { unit, window_s, tests: tests.iter().map(simulated).collect(), train })
    }

    /// As the JSON of a fit carries them.
    pub(super) fn to_json(&self) -> Value {
        let of = |simulated: &Simulated| {
            let label = &simulated.label;
            simulated.score.map(|score| {
                json!({"recording": label, "n": score.n, "velocity": {"rmse": score.velocity_rmse},
                    "position": {"mae": score.mae, "rmse": score.rmse, "max": score.max}})
            })
        };
        let list = |of_set: &[Simulated]| of_set.iter().filter_map(of).collect::<Vec<_>>();
        json!({"unit": self.unit, "window_s": self.window_s, "train": list(&self.train), "test": list(&self.tests)})
    }

    /// For a reader.
    pub(super) fn text(&self) -> String {
        let under = match self.window_s {
            Some(seconds) => format!("what was recorded, put back every {seconds} s"),
            None => "the recorded commands".to_owned(),
        };
        let mut text =
            format!("\nsimulated under {under}: error of the position, mean absolute, root mean square, largest\n");
        let train = self.train.iter().map(|simulated| ("train", simulated));
        for (role, Simulated { label, score }) in train.chain(self.tests.iter().map(|simulated| ("test", simulated))) {
            let error = score.map_or("cannot be simulated".to_owned(), |score| {
                format!("{:.4} {:.4} {:.4} {}", score.mae, score.rmse, score.max, self.unit)
            });
            // Writing to a string cannot fail.
            let _ = writeln!(text, "  {label:<32} {role:<5} {error}");
        }
        text
    }
}
