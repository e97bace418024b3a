//! Where results go: standard output for a reader or a pipe, files that appear together or not at all.

use std::io::Write;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::configuration::resolved;
use crate::error::{Error, Result, codes};
use crate::files::{refuse_place, write_together};

/// Files that one command writes, collected before the first of them is touched.
#[derive(Debug, Default)]
pub(crate) struct Outputs {
    files: Vec<(PathBuf, Vec<u8>)>,
    console: String,
}

impl Outputs {
    /// Adds a file; `-` is standard output.
    pub(crate) fn add(&mut self, path: &Path, content: impl Into<Vec<u8>>) {
        let content = content.into();
        if path == Path::new("-") {
            self.console.push_str(&String::from_utf8_lossy(&content));
        } else {
            self.files.push((path.to_owned(), content));
        }
    }

    /// Adds a result as JSON, with the options that were in force; `-` is standard output.
    pub(crate) fn add_json(&mut self, path: &Path, mut result: Value) {
        if let (Some(result), Some(options)) = (result.as_object_mut(), resolved()) {
            result.insert("configuration".to_owned(), options.clone());
        }
        self.add(path, format!("{result}\n"));
    }

    /// Refuses to write over what was read, and the same file twice.
    pub(crate) fn refuse_overwriting(&self, inputs: &[&Path]) -> Result<()> {
        refuse_overwriting(&self.files.iter().map(|(path, _)| path.as_path()).collect::<Vec<_>>(), inputs)
    }

    /// Writes all files, then standard output.
    pub(crate) fn write(self) -> Result<()> {
        let files: Vec<(&Path, &[u8])> =
            self.files.iter().map(|(path, bytes)| (path.as_path(), bytes.as_slice())).collect();
        write_together(&files)?;
        print(&self.console)
    }
}

/// Refuses files that cannot be written, before the work that leads to them: in a folder that does not exist, in place of a folder, over
/// an input, or two in one place. `-` is standard output.
///
/// # Errors
/// `FRK-I002`, `FRK-I003` or `FRK-U001`, with the file.
pub(crate) fn refuse_unwritable<'a>(outputs: impl IntoIterator<Item = &'a PathBuf>, inputs: &[&Path]) -> Result<()> {
    let outputs: Vec<&Path> =
        outputs.into_iter().map(PathBuf::as_path).filter(|path| *path != Path::new("-")).collect();
    for path in &outputs {
        refuse_place(path)?;
    }
    refuse_overwriting(&outputs, inputs)
}

fn refuse_overwriting(outputs: &[&Path], inputs: &[&Path]) -> Result<()> {
    let same =
        |a: &Path, b: &Path| a == b || a.canonicalize().ok().zip(b.canonicalize().ok()).is_some_and(|(a, b)| a == b);
    for (index, path) in outputs.iter().enumerate() {
        let read = inputs.iter().any(|input| same(path, input));
        let written = outputs[..index].iter().any(|other| same(path, other));
        if read || written {
            let what = if read { "this file is also an input" } else { "two results go to this file" };
            return Err(Error::new(&codes::USAGE, what).in_file(path.display().to_string()));
        }
    }
    Ok(())
}

/// The command as it was typed, for a shell of POSIX.
pub(crate) fn command_line() -> String {
    let is_plain =
        |word: &str| !word.is_empty() && word.chars().all(|c| c.is_alphanumeric() || "-_./,:=+%@".contains(c));
    let quoted = |word: String| if is_plain(&word) { word } else { format!("'{}'", word.replace('\'', "'\\''")) };
    let words = std::env::args_os().skip(1).map(|word| quoted(word.to_string_lossy().into_owned()));
    std::iter::once("trainer".to_string()).chain(words).collect::<Vec<_>>().join(" ")
}

/// Says a line on standard error. That nobody listens is no failure.
pub fn say(line: &str) {
    // A message that cannot be told can only be dropped.
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// Writes to standard output. A reader that has left early (`| head`) is no failure.
///
/// # Errors
/// `FRK-I001` when it cannot be written.
pub fn print(text: &str) -> Result<()> {
    is_read(text).map(drop)
}

/// Writes to standard output and says whether a reader is still there.
///
/// # Errors
/// As [`print`].
pub(crate) fn is_read(text: &str) -> Result<bool> {
    let mut console = std::io::stdout().lock();
    match console.write_all(text.as_bytes()).and_then(|()| console.flush()) {
        Ok(()) => Ok(true),
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(false),
        Err(error) => Err(Error::from_io(Path::new("standard output"), &error)),
    }
}
