//! A co-simulation unit with the library of this platform, where it has a C compiler.

use std::env::consts::OS;
use std::io;
use std::path::Path;
use std::process::Command;

use frikan_shared::image::{Image, image_crc32};

use crate::error::{Error, Result, codes};
use crate::export::fmu::{CoSimulation, Library, unit};
use crate::fit::CELLS;

/// Compilers that are tried where `CC` names none.
const COMPILERS: [&str; 3] = ["cc", "gcc", "clang"];

/// The unit as a file, and in a sentence which libraries it holds.
///
/// # Errors
/// `FRK-U005` for an image that has no such form, `FRK-I001` where the compiler's files cannot be written or read.
pub(super) fn file(image_bytes: &[u8], image: &Image<CELLS>, title: &str) -> Result<(Vec<u8>, String)> {
    let unit = unit(image, title, image_crc32(image_bytes).unwrap_or(0))?;
    let (library, told) = match library(&unit) {
        Ok(library) => (Some(library), String::new()),
        Err(why) => {
            let told = format!("The unit holds sources and no library ({why}): the importer has to compile them.\n");
            (None, told)
        }
    };
    let bytes = unit
        .archive(library.as_ref())
        .map_err(|error| Error::new(&codes::FILE_TOO_LARGE, format!("the unit cannot be packed: {error}")))?;
    Ok((bytes, told))
}

/// The library of this platform, or in words why there is none.
fn library(unit: &CoSimulation) -> std::result::Result<Library, String> {
    if !cfg!(target_pointer_width = "64") {
        return Err("this platform does not have 64 bits".to_owned());
    }
    let (platform, extension) = match OS {
        "linux" if cfg!(target_arch = "x86_64") => ("x86_64-linux", "so"),
        "macos" if cfg!(target_arch = "x86_64") => ("x86_64-darwin", "dylib"),
        "macos" => ("aarch64-darwin", "dylib"),
        other => return Err(format!("{other} on this processor has no compiler that is called here")),
    };
    let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
    for (name, text) in &unit.sources {
        std::fs::write(folder.path().join(name), text).map_err(|error| error.to_string())?;
    }
    let file = format!("{}.{extension}", unit.identifier);
    compile(folder.path(), &unit.compiled().collect::<Vec<_>>(), &file)?;
    let bytes = std::fs::read(folder.path().join(&file)).map_err(|error| error.to_string())?;
    Ok(Library { platform, file, bytes })
}

fn compile(folder: &Path, sources: &[&str], file: &str) -> std::result::Result<(), String> {
    let named = std::env::var("CC").ok();
    let compilers = named.as_deref().map_or(COMPILERS.to_vec(), |compiler| vec![compiler]);
    for compiler in compilers {
        let mut command = Command::new(compiler);
        command.current_dir(folder).args(["-std=c99", "-O2", "-fPIC", "-fvisibility=hidden", "-shared", "-o", file]);
        match command.args(sources).arg("-lm").output() {
            Ok(output) if output.status.success() => return Ok(()),
            Ok(output) => {
                let said = String::from_utf8_lossy(&output.stderr);
                return Err(format!("`{compiler}` failed: {}", said.lines().next().unwrap_or("it says nothing")));
            }
            Err(error) if error.kind() == io::ErrorKind::NotFound => {}
            Err(error) => return Err(format!("`{compiler}` cannot be run: {error}")),
        }
    }
    Err("no C compiler was found; `CC` may name one".to_owned())
}
