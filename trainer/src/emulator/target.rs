//! What a target of the firmware is: a folder with `target.toml` and `memory.x`.

use std::path::Path;

use serde::Deserialize;

use crate::did_you_mean::hint;
use crate::error::{Error, Result, codes};

/// A processor for which the firmware is built, and the machine that emulates it.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Target {
    /// Name of the folder, such as `cortex-m4f`.
    #[serde(skip)]
    pub name: String,
    /// Rust's target triple.
    pub triple: String,
    /// Compiler flags, besides the search path of `memory.x`.
    pub rustflags: Vec<String>,
    /// GCC that links, and its flags, where Rust's own linker is not installed.
    pub gcc: Vec<String>,
    /// The emulator's program.
    pub emulator: String,
    /// Arguments that choose machine and processor.
    pub machine: Vec<String>,
    /// An instruction takes `2^icount_shift` virtual nanoseconds while instructions are counted.
    pub icount_shift: u32,
}

impl Target {
    /// Reads the target `name` of the firmware in `folder`.
    pub(super) fn read(folder: &Path, name: &str) -> Result<Self> {
        let names = Self::names(folder)?;
        if !names.iter().any(|known| known == name) {
            let near = hint(name, names.iter().map(String::as_str));
            let message = format!("there is no target of this name{near}; there are host, {}", names.join(", "));
            return Err(Error::new(&codes::UNKNOWN_TARGET, message).with_value(name));
        }
        let path = folder.join("targets").join(name).join("target.toml");
        let text = std::fs::read_to_string(&path).map_err(|error| Error::from_io(&path, &error))?;
        let mut target: Self = toml::from_str(&text).map_err(|error| {
            Error::new(&codes::FIRMWARE_BUILD, error.message().to_owned()).in_file(path.display().to_string())
        })?;
        name.clone_into(&mut target.name);
        Ok(target)
    }

    /// Names of the targets of the firmware in `folder`, in alphabetical order.
    pub(super) fn names(folder: &Path) -> Result<Vec<String>> {
        let path = folder.join("targets");
        let entries = std::fs::read_dir(&path).map_err(|error| Error::from_io(&path, &error))?;
        let mut names = Vec::new();
        for entry in entries {
            let entry = entry.map_err(|error| Error::from_io(&path, &error))?;
            if entry.path().join("target.toml").is_file() {
                names.push(entry.file_name().to_string_lossy().into_owned());
            }
        }
        names.sort();
        Ok(names)
    }
}
