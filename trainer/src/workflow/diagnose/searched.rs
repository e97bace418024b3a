//! How much of a long recording was searched, told.

use crate::recording::Recording;
use serde_json::{Value, json};

/// The samples of the stretches of a long recording that were searched, and its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Searched {
    /// Samples that were searched.
    pub samples: usize,
    /// Samples of all recordings.
    pub of: usize,
}

impl Searched {
    /// So many samples of recordings.
    pub(super) fn new(samples: usize, recordings: &[Recording]) -> Self {
        Self { samples, of: recordings.iter().map(Recording::len).sum() }
    }

    /// For a reader.
    pub(super) fn sentence(&self) -> String {
        format!(
            "Searched in stretches spread over the recording, {} of its {} samples: what happened once beside them is not seen.",
            self.samples, self.of
        )
    }

    /// As the JSON of a diagnosis carries it.
    pub(super) fn to_json(self) -> Value {
        json!({ "samples": self.samples, "of": self.of })
    }
}
