//! `trainer predict`: a recording with the model's prediction beside it.

use std::path::PathBuf;

use clap::Args;

use super::measurement::{self, Source};
use super::output::{Outputs, refuse_unwritable, say};
use crate::error::Result;
use crate::fit::model;
use crate::workflow::predict::predict;

/// Copy a recording and add what the model predicts, `predicted_<quantity>_<unit>` and `residual_<unit>`.
///
/// Of a joint that reports no torque, with `[actuator]` in joint.toml and what `fit` identified of it beside the image, the torque is what the actuator
/// makes of its commands, `actuator_torque_Nm`; `trainer rollout` simulates the motion under them.
#[derive(Args, Clone, Debug)]
pub struct Predict {
    /// Image that predicts
    #[arg(value_name = "MODEL.frk")]
    pub model: PathBuf,
    /// Recording to predict
    #[arg(value_name = "RECORDING")]
    pub recording: PathBuf,
    /// joint.toml: column names, rigid body, drive, limits
    #[arg(long, value_name = "JOINT.toml")]
    pub joint: Option<PathBuf>,
    /// Recording to write
    #[arg(short, long, value_name = "OUT.csv")]
    pub output: PathBuf,
    /// Say nothing on standard error
    #[arg(long)]
    pub quiet: bool,
}

/// Runs the command.
///
/// # Errors
/// `FRK-D...` when image or recording cannot be used or lack what the model reads; nothing is written then.
pub fn run(arguments: &Predict) -> Result<()> {
    refuse_unwritable([&arguments.output], &[arguments.model.as_path(), arguments.recording.as_path()])?;
    let (_, image) = model::load(&arguments.model)?;
    let joint = measurement::joint(arguments.joint.as_deref(), arguments.quiet)?;
    let joint = measurement::with_identified(joint, &arguments.model)?;
    let predicted = predict(&image.model, Source::from(&arguments.recording), &joint)?;
    let mut outputs = Outputs::default();
    outputs.add(&arguments.output, predicted.csv);
    outputs.write()?;
    if !arguments.quiet {
        predicted.warnings.iter().for_each(|warning| say(&warning.to_string()));
    }
    Ok(())
}
