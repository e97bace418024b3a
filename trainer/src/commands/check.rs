//! `trainer check`: what a recording is worth before anything is fitted to it.

use std::path::{Path, PathBuf};

use clap::Args;

use super::measurement::{self, Source};
use super::output::{Outputs, refuse_unwritable};
use crate::error::Result;
use crate::workflow::check::check;

/// Tell the quality of recordings, what can be identified from them and what to record next.
///
/// Exit status: 0 good or usable, 2 usage, 3 a recording cannot be read or is at fault, 4 nothing can be identified, 5 input or output.
#[derive(Args, Clone, Debug)]
pub struct Check {
    /// Recordings of one joint; `-` is standard input
    #[arg(required = true, value_name = "RECORDING")]
    pub recordings: Vec<PathBuf>,
    /// joint.toml: column names, rigid body, drive, limits
    #[arg(long, value_name = "JOINT.toml")]
    pub joint: Option<PathBuf>,
    /// Also write the result as JSON; `-` for standard output, in place of the text
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Say nothing but the result
    #[arg(long)]
    pub quiet: bool,
}

/// Runs the command; the exit status is 0, 3 or 4.
///
/// # Errors
/// As [`check()`], and whatever reading the joint or writing reports.
pub fn run(arguments: &Check) -> Result<u8> {
    let read = arguments.recordings.iter().chain(&arguments.joint).map(PathBuf::as_path);
    refuse_unwritable(&arguments.json, &read.collect::<Vec<_>>())?;
    let joint = measurement::joint(arguments.joint.as_deref(), arguments.quiet)?;
    let recordings: Vec<Source<'_>> = arguments.recordings.iter().map(Source::from).collect();
    let checked = check(&recordings, &joint)?;
    let mut outputs = Outputs::default();
    if let Some(path) = &arguments.json {
        outputs.add_json(path, checked.json());
    }
    if arguments.json.as_deref() != Some(Path::new("-")) {
        outputs.add("-".as_ref(), checked.text());
    }
    outputs.write()?;
    Ok(checked.status)
}
