//! Recordings and joint files as Python hands them over.

use frikan_trainer::error::{Error, Result, codes};
use frikan_trainer::joint::Joint;
use frikan_trainer::workflow::Source;
use pyo3::prelude::*;

/// A path, or a name with the content of such a file.
#[derive(FromPyObject)]
pub struct Recording(String, Option<Vec<u8>>);

impl Recording {
    /// Where the trainer reads it.
    pub fn source(&self) -> Source<'_> {
        match &self.1 {
            None => Source::from(&self.0),
            Some(bytes) => Source::Bytes { label: &self.0, bytes },
        }
    }
}

/// What is known of the joint: a path, or (`true`) what such a file says as JSON; nothing where `None`.
///
/// # Errors
/// As [`Joint::load`].
pub fn joint(file: Option<(bool, String)>) -> Result<Joint> {
    match file {
        None => Ok(Joint::default()),
        Some((false, path)) => Joint::load(path.as_ref()),
        Some((true, json)) => {
            let refused = |why: String| Error::new(&codes::BAD_JOINT_FILE, why);
            let value: toml::Value = serde_json::from_str(&json).map_err(|error| refused(error.to_string()))?;
            Joint::parse(&toml::to_string(&value).map_err(|error| refused(error.to_string()))?)
        }
    }
}
