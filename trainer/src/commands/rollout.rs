//! `trainer rollout`: a joint simulated with an image under what a recording commanded, and how far it comes off.

use std::path::{Path, PathBuf};

use clap::Args;

use super::measurement;
use super::output::{Outputs, print, refuse_unwritable, say};
use crate::error::Result;
use crate::fit::model;
use crate::workflow::rollout::rollout;

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
/// As [`rollout()`], and where a file cannot be read or written; nothing is written then.
pub fn run(arguments: &Rollout) -> Result<()> {
    let read = [Some(arguments.model.as_path()), Some(&arguments.recording), arguments.joint.as_deref()];
    let written = arguments.output.iter().chain(&arguments.json);
    refuse_unwritable(written, &read.into_iter().flatten().collect::<Vec<_>>())?;
    let (_, image) = model::load(&arguments.model)?;
    let joint = measurement::joint(arguments.joint.as_deref(), arguments.quiet)?;
    let joint = measurement::with_identified(joint, &arguments.model)?;
    let done = rollout(&image.model, (&arguments.recording).into(), &joint, arguments.window)?;
    let mut outputs = Outputs::default();
    if let Some(path) = &arguments.output {
        outputs.add(path, done.csv()?);
    }
    if let Some(path) = &arguments.json {
        outputs.add_json(path, done.json());
    }
    outputs.write()?;
    if !arguments.quiet {
        done.warnings.iter().for_each(|warning| say(&warning.to_string()));
    }
    // With JSON on standard output the text would get in its way.
    if arguments.json.as_deref() == Some(Path::new("-")) {
        return Ok(());
    }
    print(&done.text())
}
