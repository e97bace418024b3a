//! Where recordings come from, and how much memory reading them may take.

use crate::error::Result;
use crate::joint::Joint;
use crate::recording::{self, Recording};
use std::path::Path;

/// Where a recording comes from.
#[derive(Clone, Copy, Debug)]
pub enum Source<'a> {
    /// A file of any format that is read; `-` is standard input.
    File(&'a Path),
    /// The content of such a file, with the name to call it by.
    Bytes {
        /// Name in messages and reports.
        label: &'a str,
        /// The whole content.
        bytes: &'a [u8],
    },
}

impl<'a, P: AsRef<Path> + ?Sized> From<&'a P> for Source<'a> {
    fn from(path: &'a P) -> Self {
        Self::File(path.as_ref())
    }
}

impl Source<'_> {
    /// The recording as it stands there.
    ///
    /// # Errors
    /// As [`recording::load`].
    pub(crate) fn read(self, joint: &Joint) -> Result<Recording> {
        match self {
            Self::File(path) => recording::load(path, joint),
            Self::Bytes { label, bytes } => recording::parse(label, bytes, joint).map_err(|error| error.in_file(label)),
        }
    }

    /// The same without the text of its rows, for what only learns from it.
    ///
    /// # Errors
    /// As [`recording::load`].
    pub(crate) fn read_numbers(self, joint: &Joint, reading: Reading<'_>) -> Result<Recording> {
        match self {
            Self::File(path) => recording::load_numbers(path, joint, reading.inputs, reading.memory_bytes),
            Self::Bytes { .. } => self.read(joint),
        }
    }

    /// The recordings of each of these joints that stand there together.
    ///
    /// # Errors
    /// As [`recording::load_joints`].
    pub(crate) fn read_joints(self, joints: &[Joint]) -> Result<Vec<Recording>> {
        match self {
            Self::File(path) => recording::load_joints(path, joints),
            Self::Bytes { label, bytes } => {
                recording::parse_joints(label, bytes, joints).map_err(|error| error.in_file(label))
            }
        }
    }
}

/// Memory that reading, fitting and diagnosing stay within unless another one is asked for, MB.
const DEFAULT_MEMORY_MB: u32 = 1000;

/// Share of it that the search of a diagnosis takes beside what is read (docs/size.md, a million rows).
const SEARCH_SHARE: f64 = 0.6;

/// What is read of a recording.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reading<'a> {
    /// Channels that a law is to read, however long the recording is.
    inputs: &'a [String],
    /// Memory to stay within, B.
    memory_bytes: f64,
    /// Memory of all over the default one.
    of_default: f64,
}

impl<'a> Reading<'a> {
    /// One of so many recordings that share a memory, MB.
    pub(crate) fn of(inputs: &'a [String], memory_mb: Option<u32>, recordings: usize) -> Self {
        let memory_mb = f64::from(memory_mb.unwrap_or(DEFAULT_MEMORY_MB));
        Self {
            inputs,
            memory_bytes: 1e6 * memory_mb / recordings.max(1) as f64,
            of_default: memory_mb / f64::from(DEFAULT_MEMORY_MB),
        }
    }

    /// The same where recordings are searched once they are read.
    pub(crate) fn beside_search(self) -> Self {
        Self { memory_bytes: (1.0 - SEARCH_SHARE) * self.memory_bytes, ..self }
    }

    /// The memory of all recordings over the default one.
    pub(crate) fn share_of_default(self) -> f64 {
        self.of_default
    }
}

impl Default for Reading<'_> {
    fn default() -> Self {
        Self::of(&[], None, 1)
    }
}
