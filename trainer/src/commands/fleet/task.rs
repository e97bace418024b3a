//! The list of tasks, a line each, and where their results lie.

use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, codes};
use crate::files::{open, read_whole};

/// Largest list that is read, bytes: a million tasks.
const LIST_LIMIT_BYTES: u64 = 1 << 30;

/// Longest line of it, bytes.
const LINE_LIMIT_BYTES: u64 = 1 << 20;

/// Largest result that is read, bytes.
const RESULT_LIMIT_BYTES: u64 = 64 << 20;

/// One recording to fit. Paths are relative to the folder of the list, where they lie in it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Task {
    /// Number of the line, from 0 on.
    pub(super) index: usize,
    /// Name of the joint.
    pub(super) joint: String,
    /// Joints of one kind are siblings.
    pub(super) kind: String,
    /// Date of the recording, ISO 8601.
    pub(super) date: Option<String>,
    /// The recording.
    pub(super) recording: String,
    /// Its `joint.toml`.
    pub(super) joint_file: Option<String>,
    /// Seed of the training.
    pub(super) seed: u64,
}

/// What a task has left behind.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Done {
    /// `frikan.result/1`.
    pub(super) schema: String,
    /// The task itself.
    pub(super) task: Task,
    /// Exit status of the fit: 0, or 4 where it may not be relied upon; any other is a failure.
    pub(super) exit_status: u8,
    /// Why it failed, or may not be relied upon.
    pub(super) error: Option<Failure>,
    /// The strongest wave over position that the image leaves: amplitude, and radians of its phase per unit of position.
    pub(super) ripple: Option<[f64; 2]>,
    /// The fit as `trainer fit --json` writes it, but for the time that it took.
    pub(super) fit: Option<serde_json::Value>,
}

/// A stable code and a sentence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Failure {
    pub(super) code: String,
    pub(super) message: String,
}

/// Name of the file by which the tables of a fleet are known.
pub(super) const FLEET_FILE: &str = "fleet.json";

/// Name of the schema of a result.
pub(super) const SCHEMA: &str = "frikan.result/1";

/// A list of tasks.
#[derive(Debug)]
pub(super) struct Tasks {
    path: PathBuf,
}

impl Tasks {
    /// The list in a file, which is read when it is asked.
    pub(super) fn in_file(path: &Path) -> Self {
        Self { path: path.to_owned() }
    }

    /// One task. The lines before it are passed over, for every task of a long list does so; those behind it are not read.
    ///
    /// # Errors
    /// `FRK-I...` when the list cannot be read, `FRK-U001` where there is no such task, `FRK-D044` where its line is none.
    pub(super) fn get(&self, index: usize) -> Result<Task> {
        let failed = |error: &std::io::Error| Error::from_io(&self.path, error);
        let mut list = BufReader::new(open(&self.path)?);
        for _ in 0..index {
            list.skip_until(b'\n').map_err(|error| failed(&error))?;
        }
        let mut line = Vec::new();
        list.take(LINE_LIMIT_BYTES).read_until(b'\n', &mut line).map_err(|error| failed(&error))?;
        if line.is_empty() {
            let message = format!("there are {} tasks, counted from 0", self.text()?.lines().count());
            return Err(Error::new(&codes::USAGE, message).with_value(index.to_string()).in_file(self.name()));
        }
        self.task(index, &line)
    }

    /// Every task.
    ///
    /// # Errors
    /// `FRK-I...` when the list cannot be read, `FRK-D044` with the line that is no task.
    pub(super) fn all(&self) -> Result<Vec<Task>> {
        self.text()?.lines().enumerate().map(|(index, line)| self.task(index, line.as_bytes())).collect()
    }

    fn text(&self) -> Result<String> {
        let text = String::from_utf8(read_whole(&self.path, LIST_LIMIT_BYTES)?);
        text.map_err(|error| Error::new(&codes::BAD_TASKS, error.to_string()).in_file(self.name()))
    }

    fn name(&self) -> String {
        self.path.display().to_string()
    }

    fn task(&self, index: usize, line: &[u8]) -> Result<Task> {
        let refused = |why: String| Error::new(&codes::BAD_TASKS, why).at_row(index as u64 + 1).in_file(self.name());
        let task: Task = serde_json::from_slice(line).map_err(|error| refused(error.to_string()))?;
        if task.index == index {
            return Ok(task);
        }
        Err(refused(format!("this line is task {index}, not {}", task.index)))
    }

    /// A path of a task as it is opened.
    pub(super) fn resolve(&self, path: &str) -> PathBuf {
        folder_of(&self.path).join(path)
    }

    /// Where the result of a task lies, and the image beside it.
    pub(super) fn results(&self, task: &Task) -> [PathBuf; 2] {
        ["json", "frk"].map(|ending| results_of(&self.path).join(format!("{:06}.{ending}", task.index)))
    }

    /// The result of a task; `None` where there is none, or that of another task.
    ///
    /// # Errors
    /// `FRK-I...` when it is there and cannot be read.
    pub(super) fn result(&self, task: &Task) -> Result<Option<Done>> {
        let [path, _] = self.results(task);
        if !path.exists() {
            return Ok(None);
        }
        let done: Option<Done> = serde_json::from_slice(&read_whole(&path, RESULT_LIMIT_BYTES)?).ok();
        Ok(done.filter(|done| done.schema == SCHEMA && done.task == *task))
    }
}

/// The folder in which a file lies.
pub(super) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    }
}

/// The folder of the results of a list.
pub(super) fn results_of(list: &Path) -> PathBuf {
    list.with_extension("results")
}
