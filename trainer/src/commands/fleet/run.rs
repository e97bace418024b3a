//! `trainer run`: one task of a list.

use std::path::PathBuf;

use clap::Args;
use serde_json::Value;

use super::task::{Done, Failure, SCHEMA, Task, Tasks, folder_of};
use crate::commands::fit::in_pool;
use crate::commands::output::{print, say};
use crate::error::{Error, Result};
use crate::files::{create_folder, write_together};
use crate::fit::Options;
use crate::fleet::{Rows, ripple};
use crate::joint::Joint;
use crate::recording::Quantity;
use crate::workflow::Source;
use crate::workflow::fit::{Fitted, fit};

/// Do one task of a list: fit its recording, and leave the result where `gather` finds it.
///
/// A task that is done already is not done again; one that was killed has left nothing. A recording that cannot be fitted leaves a
/// result that says why, and the exit status is that of `fit`.
#[derive(Args, Clone, Debug)]
pub struct Run {
    /// List that `plan` wrote
    #[arg(long, value_name = "TASKS.jsonl")]
    pub tasks: PathBuf,
    /// Which line of it, counted from 0
    #[arg(long, value_name = "N")]
    pub index: usize,
    /// Do it again even where it is done
    #[arg(long)]
    pub force: bool,
    /// Threads to use; all when absent. The result does not depend on it
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    pub threads: Option<u16>,
}

/// Runs the command; the exit status is that of the fit.
///
/// # Errors
/// `FRK-D044` for a list that is none, `FRK-U001` for a number beyond its end, `FRK-I...` where the result cannot be written. That a
/// recording cannot be fitted is no error but a result.
pub fn run(arguments: &Run) -> Result<u8> {
    let tasks = Tasks::in_file(&arguments.tasks);
    let task = &tasks.get(arguments.index)?;
    let before = if arguments.force { None } else { tasks.result(task)?.filter(|done| done.fit.is_some()) };
    let done = match before {
        Some(done) => done,
        None => {
            let (done, image) = in_pool(arguments.threads, || of_task(&tasks, task))?;
            leave(&tasks, &done, image)?;
            done
        }
    };
    match &done.error {
        Some(failure) => say(&format!("{}: {}", failure.code, failure.message)),
        None => print(&format!("{}: done\n", task.recording))?,
    }
    Ok(done.exit_status)
}

/// What a task comes to, with its image.
fn of_task(tasks: &Tasks, task: &Task) -> (Done, Option<Vec<u8>>) {
    let done =
        Done { schema: SCHEMA.to_owned(), task: task.clone(), exit_status: 0, error: None, ripple: None, fit: None };
    let failed = |error: &Error| {
        (error.exit_status(), Some(Failure { code: error.code().id.to_owned(), message: said(task, error) }))
    };
    match fitted(tasks, task) {
        Err(error) => {
            let (exit_status, error) = failed(&error);
            (Done { exit_status, error, ..done }, None)
        }
        Ok(fitted) => {
            let (exit_status, error) = fitted.doubt().as_ref().map_or((0, None), failed);
            let mut fit = fitted.json();
            // A result is the same whenever and wherever it comes about.
            fit["seconds"] = Value::Null;
            let done = Done { exit_status, error, ripple: strongest_ripple(&fitted), fit: Some(fit), ..done };
            let withheld = fitted.is_withheld();
            (done, (!withheld).then_some(fitted.outcome.image))
        }
    }
}

/// An error without its code, which stands beside it, and with the recording as the list calls it, from wherever it was run.
fn said(task: &Task, error: &Error) -> String {
    let text = error.to_string().replacen(&format!("{}: ", error.code().id), "", 1);
    match error.file() {
        Some(file) if file.ends_with(&task.recording) => text.replacen(file, &task.recording, 1),
        _ => text,
    }
}

fn fitted(tasks: &Tasks, task: &Task) -> Result<Fitted> {
    let joint = match &task.joint_file {
        Some(path) => Joint::load(&tasks.resolve(path))?,
        None => Joint::default(),
    };
    let recording = tasks.resolve(&task.recording);
    let options = Options { seed: task.seed, ..Options::default() };
    fit(&[Source::from(&recording)], &[], &joint, &options, &|_| {})
}

/// The strongest wave over position in what the image leaves, where the position is known.
fn strongest_ripple(fitted: &Fitted) -> Option<[f64; 2]> {
    let (recording, trace) = (fitted.recordings.first()?, fitted.outcome.train.first()?);
    let residual: Vec<f64> = trace.measured.iter().zip(&trace.predicted).map(|(m, p)| m - p).collect();
    let position: Vec<f64> = recording.values(Quantity::Position)?.iter().step_by(trace.stride).copied().collect();
    let found = ripple(&Rows { position: &position, velocity: &trace.velocity, residual: &residual })?;
    Some([found.amplitude, found.order])
}

/// Writes image and result, together or not at all.
fn leave(tasks: &Tasks, done: &Done, image: Option<Vec<u8>>) -> Result<()> {
    let [result, image_file] = tasks.results(&done.task);
    let folder = folder_of(&result);
    create_folder(folder)?;
    let text = serde_json::json!(done).to_string() + "\n";
    let mut files = Vec::new();
    files.extend(image.as_ref().map(|image| (image_file.as_path(), image.as_slice())));
    files.push((result.as_path(), text.as_bytes()));
    write_together(&files)
}
