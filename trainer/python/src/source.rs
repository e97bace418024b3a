//! Recordings and joint files as Python hands them over.

use frikan_trainer::error::{Error, Result, codes};
use frikan_trainer::files::read_text;
use frikan_trainer::joint::{ArmFile, Joint};
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

/// Largest text that is read, in bytes.
const TEXT_LIMIT_BYTES: u64 = 64 << 20;

/// What is known of the joint: a path, or (`true`) what such a file says as JSON; nothing where `None`.
///
/// # Errors
/// As [`Joint::load`].
pub fn joint(file: Option<(bool, String)>) -> Result<Joint> {
    match file {
        None => Ok(Joint::default()),
        Some((false, path)) => Joint::load(path.as_ref()),
        Some((true, json)) => Joint::parse(&toml_of(&json)?),
    }
}

/// The same of an arm.
///
/// # Errors
/// As [`ArmFile::parse`], and where the file cannot be read.
pub fn arm_file(file: Option<(bool, String)>) -> Result<ArmFile> {
    match file {
        None => Ok(ArmFile::default()),
        Some((false, path)) => ArmFile::parse(&text(&path)?).map_err(|error| error.in_file(path)),
        Some((true, json)) => ArmFile::parse(&toml_of(&json)?),
    }
}

/// A text file.
///
/// # Errors
/// `FRK-I...` where it cannot be read.
pub fn text(path: &str) -> Result<String> {
    read_text(path.as_ref(), TEXT_LIMIT_BYTES)
}

fn toml_of(json: &str) -> Result<String> {
    let refused = |why: String| Error::new(&codes::BAD_JOINT_FILE, why);
    let value: toml::Value = serde_json::from_str(json).map_err(|error| refused(error.to_string()))?;
    toml::to_string(&value).map_err(|error| refused(error.to_string()))
}
