//! A joint simulated with an image under what a recording commanded.

use serde_json::{Value, json};

use super::columns::with_columns;
use super::recordings::{Warning, motion};
use super::source::Source;
use crate::error::{Error, Result, codes};
use crate::fit::HostModel;
use crate::joint::Joint;
use crate::recording::{Axis, Recording};
use crate::rollout::{Rollout, State, default_window_s, of_image};

/// A simulated motion beside the recorded one.
#[derive(Clone, Debug)]
pub struct RolledOut {
    rollout: Rollout,
    recording: Recording,
    window: Option<f64>,
    unit: &'static str,
    /// What the checks of the recording noticed.
    pub warnings: Vec<Warning>,
}

/// Simulates a joint with a model under the commands of a recording; it is put back to the recorded state after `window` seconds, the
/// usual ones of its actuator where `None`.
///
/// # Errors
/// `FRK-U001` of a window that is not above zero, as [`of_image`], and whatever reading a recording reports.
pub fn rollout(model: &HostModel, recording: Source<'_>, joint: &Joint, window: Option<f64>) -> Result<RolledOut> {
    if let Some(seconds) = window.filter(|seconds| !(seconds.is_finite() && *seconds > 0.0)) {
        let message = "the window has to be a finite number of seconds above zero";
        return Err(Error::new(&codes::USAGE, message).with_value(seconds.to_string()));
    }
    let (recording, warnings) = motion(recording.read(joint)?, joint)?;
    let window = window.or_else(|| default_window_s(joint.actuator.kind));
    let rollout = of_image(model, &recording, joint, window)?;
    let unit = if recording.axis == Axis::Rotary { "rad" } else { "m" };
    Ok(RolledOut { rollout, recording, window, unit, warnings })
}

impl RolledOut {
    /// The recording with the simulated motion beside it, as CSV.
    ///
    /// # Errors
    /// `FRK-I001` where it cannot be written as a table.
    pub fn csv(&self) -> Result<Vec<u8>> {
        let Self { rollout, unit, .. } = self;
        let of = |pick: fn(&State) -> f64| rollout.simulated.iter().map(pick).collect::<Vec<f64>>();
        let error = rollout.simulated.iter().zip(&rollout.recorded).map(|(s, r)| r.position - s.position);
        let added = [
            (format!("simulated_position_{unit}"), of(|state| state.position)),
            (format!("simulated_velocity_{unit}_s"), of(|state| state.velocity)),
            (format!("position_error_{unit}"), error.collect()),
        ];
        with_columns(&self.recording, &added)
    }

    /// The result as JSON, schema `frikan.rollout/1`.
    #[must_use]
    pub fn json(&self) -> Value {
        summary(self)
    }

    /// The result for a terminal.
    #[must_use]
    pub fn text(&self) -> String {
        text(self)
    }
}

/// The object of schema `frikan.rollout/1`.
fn summary(RolledOut { rollout, unit, window, .. }: &RolledOut) -> Value {
    let score = &rollout.score;
    json!({
        "schema": "frikan.rollout/1",
        "n": score.n,
        "position": { "mae": score.mae, "rmse": score.rmse, "max": score.max },
        "velocity": { "rmse": score.velocity_rmse },
        "unit": unit,
        "window_s": window,
    })
}

fn text(RolledOut { rollout, unit, window, .. }: &RolledOut) -> String {
    let score = &rollout.score;
    let from = window.map_or_else(
        || "from the first recorded state on".to_owned(),
        |seconds| format!("put back to the recorded state every {seconds} s"),
    );
    format!(
        "rows        {}, {from}\nposition    mean absolute error {:.4} {unit}, root mean square {:.4}, largest {:.4}\n\
         velocity    root mean square error {:.4} {unit}/s\n",
        score.n, score.mae, score.rmse, score.max, score.velocity_rmse
    )
}
