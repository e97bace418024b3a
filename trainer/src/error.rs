//! One error for the whole trainer: a stable code, the place in the file, and one plain sentence.
//!
//! Knows no room. Every other module reports through [`Error`]; [`codes`] holds what `trainer explain` says.

pub mod codes;

use std::fmt;
use std::path::Path;

pub use codes::Code;

/// What kind of failure a code stands for; decides the exit status.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Class {
    /// The command line or `joint.toml` asks for something that does not exist.
    Usage,
    /// A recording, an image or `joint.toml` holds data that cannot be used.
    Data,
    /// Fitted, but the data do not determine the result, or the optimiser did not converge.
    NotIdentifiable,
    /// A file could not be read or written.
    InputOutput,
    /// Told beside a result: what was wrong was put right or left out.
    Warning,
}

impl Class {
    /// Exit status of the command line, as promised to scripts.
    #[must_use]
    pub const fn exit_status(self) -> u8 {
        match self {
            Self::Usage => 2,
            Self::Data => 3,
            Self::NotIdentifiable => 4,
            Self::InputOutput => 5,
            Self::Warning => 0,
        }
    }
}

/// A failure with its stable code and, as far as known, file, row, column and value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Error {
    inner: Box<Report>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
struct Report {
    code: &'static Code,
    file: Option<String>,
    row: Option<u64>,
    column: Option<String>,
    value: Option<String>,
    message: String,
}

/// Longest value that is quoted in a message, in characters.
const QUOTED_CHARACTERS: usize = 40;

impl Error {
    /// A failure of the given code, told in one plain sentence without a final stop.
    #[must_use]
    pub fn new(code: &'static Code, message: impl Into<String>) -> Self {
        let report = Report { code, file: None, row: None, column: None, value: None, message: message.into() };
        Self { inner: Box::new(report) }
    }

    /// An operating-system failure on `path`, worded for its kind.
    #[must_use]
    pub fn from_io(path: &Path, error: &std::io::Error) -> Self {
        use std::io::ErrorKind;
        let (code, message) = match error.kind() {
            ErrorKind::NotFound => (&codes::FILE_NOT_FOUND, "there is no such file or folder".to_owned()),
            ErrorKind::IsADirectory => (&codes::IS_A_DIRECTORY, "this is a folder, not a file".to_owned()),
            _ => (&codes::INPUT_OUTPUT, error.to_string()),
        };
        Self::new(code, message).in_file(path.display().to_string())
    }

    /// Adds the file; keeps one that is already there.
    #[must_use]
    pub fn in_file(mut self, file: impl Into<String>) -> Self {
        self.inner.file.get_or_insert_with(|| file.into());
        self
    }

    /// Adds the row: the line number in the file, the header being row 1.
    #[must_use]
    pub fn at_row(mut self, row: u64) -> Self {
        self.inner.row = Some(row);
        self
    }

    /// Adds the column, by its name in the file.
    #[must_use]
    pub fn in_column(mut self, column: impl Into<String>) -> Self {
        self.inner.column = Some(column.into());
        self
    }

    /// Adds the offending value; control characters are escaped and long values are cut.
    #[must_use]
    pub fn with_value(mut self, value: impl AsRef<str>) -> Self {
        let mut shown: String = value.as_ref().chars().take(QUOTED_CHARACTERS).flat_map(char::escape_debug).collect();
        if value.as_ref().chars().nth(QUOTED_CHARACTERS).is_some() {
            shown.push_str("...");
        }
        self.inner.value = Some(shown);
        self
    }

    /// The registry entry of this failure.
    #[must_use]
    pub fn code(&self) -> &'static Code {
        self.inner.code
    }

    /// Exit status of the command line for this failure.
    #[must_use]
    pub fn exit_status(&self) -> u8 {
        self.inner.code.class.exit_status()
    }

    /// File in which the failure lies.
    #[must_use]
    pub fn file(&self) -> Option<&str> {
        self.inner.file.as_deref()
    }

    /// Line number in the file, the header being row 1.
    #[must_use]
    pub fn row(&self) -> Option<u64> {
        self.inner.row
    }

    /// Column by its name in the file.
    #[must_use]
    pub fn column(&self) -> Option<&str> {
        self.inner.column.as_deref()
    }

    /// The offending value as written in the file.
    #[must_use]
    pub fn value(&self) -> Option<&str> {
        self.inner.value.as_deref()
    }

    /// The sentence without code and place.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.inner.message
    }
}

/// `file:row:column: CODE: sentence (value "...")`, leaving out what is not known.
impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let report = &self.inner;
        if let Some(file) = &report.file {
            write!(f, "{file}:")?;
        }
        if let Some(row) = report.row {
            write!(f, "{row}:")?;
        }
        if let Some(column) = &report.column {
            write!(f, "{column}:")?;
        }
        if report.file.is_some() || report.row.is_some() || report.column.is_some() {
            f.write_str(" ")?;
        }
        write!(f, "{}: {}", report.code.id, report.message)?;
        if let Some(value) = &report.value {
            write!(f, " (value \"{value}\")")?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {}

/// Result of anything in the trainer that can fail.
pub type Result<T, E = Error> = std::result::Result<T, E>;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn display_gives_place_code_sentence_and_value() {
        let error = Error::new(&codes::NOT_A_NUMBER, "this is not a number")
            .at_row(17)
            .in_column("torque_Nm")
            .with_value("n/a")
            .in_file("arm.csv");
        assert_eq!(error.to_string(), "arm.csv:17:torque_Nm: FRK-D005: this is not a number (value \"n/a\")");
        assert_eq!(error.exit_status(), 3);
    }

    #[test]
    fn a_long_or_binary_value_is_cut_and_escaped() {
        let error = Error::new(&codes::NOT_A_NUMBER, "x").with_value(format!("\u{1}{}", "9".repeat(1000)));
        let value = error.value().unwrap();
        assert!(value.starts_with("\\u{1}") && value.ends_with("...") && value.len() < 60, "{value}");
    }

    #[test]
    fn the_first_file_wins() {
        let error = Error::new(&codes::EMPTY_FILE, "x").in_file("inner.csv").in_file("outer.csv");
        assert_eq!(error.file(), Some("inner.csv"));
    }
}
