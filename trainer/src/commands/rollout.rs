//! `trainer rollout`: a joint simulated with an image under what a recording commanded, and how far it comes off.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::json;

use super::measurement::{self, motion};
use super::output::{Outputs, print, refuse_unwritable, say};
use crate::error::{Error, Result, codes};
use crate::fit::model;
use crate::recording::{self, Axis};
use crate::rollout::{Rollout as Simulated, State, default_window_s, of_image};
use crate::workflow::columns::with_columns;

/// Simulate the joint with an image under the commands of a recording, and say how far the motion comes off.
#[derive(Args, Clone, Debug)]
pub struct Rollout {
    /// Image with friction and rigid body of the joint
    #[arg(value_name = "MODEL.frk")]
    pub model: PathBuf,
    /// Recording with what was commanded
    #[arg(value_name = "RECORDING")]
    pub recording: PathBuf,
    /// joint.toml: columns, `[actuator]`, `[payload]`
    #[arg(long, value_name = "JOINT.toml")]
    pub joint: Option<PathBuf>,
    /// Put the joint back to the recorded state after so many seconds; 0.5 under a recorded torque, current, duty or voltage and never under a
    /// position command when absent
    #[arg(long, value_name = "S")]
    pub window: Option<f64>,
    /// Recording to write, with the simulated motion beside it
    #[arg(short, long, value_name = "OUT.csv")]
    pub output: Option<PathBuf>,
    /// Also write the result as JSON; `-` for standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Say nothing on standard error
    #[arg(long)]
    pub quiet: bool,
}

/// Runs the command.
///
/// # Errors
/// As [`of_image`], and where a file cannot be read or written; nothing is written then.
pub fn run(arguments: &Rollout) -> Result<()> {
    let window = arguments.window;
    if let Some(seconds) = window.filter(|seconds| !(seconds.is_finite() && *seconds > 0.0)) {
        let message = "`--window` has to be a finite number of seconds above zero";
        return Err(Error::new(&codes::USAGE, message).with_value(seconds.to_string()));
    }
    let read = [Some(arguments.model.as_path()), Some(&arguments.recording), arguments.joint.as_deref()];
    let written = arguments.output.iter().chain(&arguments.json);
    refuse_unwritable(written, &read.into_iter().flatten().collect::<Vec<_>>())?;
    let (_, image) = model::load(&arguments.model)?;
    let joint = measurement::joint(arguments.joint.as_deref(), arguments.quiet)?;
    let joint = measurement::with_identified(joint, &arguments.model)?;
    let (recording, warnings) = motion(recording::load(&arguments.recording, &joint)?, &joint)?;
    let window = window.or_else(|| default_window_s(joint.actuator.kind));
    let rollout = of_image(&image.model, &recording, &joint, window)?;
    let (unit, rate) = if recording.axis == Axis::Rotary { ("rad", "rad_s") } else { ("m", "m_s") };

    let mut outputs = Outputs::default();
    if let Some(path) = &arguments.output {
        let of = |pick: fn(&State) -> f64| rollout.simulated.iter().map(pick).collect::<Vec<f64>>();
        let error = rollout.simulated.iter().zip(&rollout.recorded).map(|(s, r)| r.position - s.position);
        let added = [
            (format!("simulated_position_{unit}"), of(|state| state.position)),
            (format!("simulated_velocity_{rate}"), of(|state| state.velocity)),
            (format!("position_error_{unit}"), error.collect()),
        ];
        outputs.add(path, with_columns(&recording, &added)?);
    }
    if let Some(path) = &arguments.json {
        outputs.add(path, format!("{}\n", summary(&rollout, unit, window)));
    }
    outputs.write()?;
    if !arguments.quiet {
        warnings.iter().for_each(|warning| say(&warning.to_string()));
    }
    // With JSON on standard output the text would get in its way.
    if arguments.json.as_deref() == Some(Path::new("-")) {
        return Ok(());
    }
    print(&text(&rollout, unit, window))
}

fn summary(rollout: &Simulated, unit: &str, window: Option<f64>) -> serde_json::Value {
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

fn text(rollout: &Simulated, unit: &str, window: Option<f64>) -> String {
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
