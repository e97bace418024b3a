//! Lines as a user types them into a shell.

use std::path::Path;
use std::process::Command;

use crate::command::trainer;
use crate::fixtures::folder;

/// What a shell prints of a line on standard output, with `trainer` among its programs.
///
/// # Panics
/// Where the line ends with a status other than 0 or 1: a diagnosis that finds something ends with 1.
#[must_use]
pub fn printed(at: &Path, line: &str) -> String {
    let programs = trainer().parent().expect("a program lies in a folder").to_owned();
    let path = std::env::var_os("PATH").unwrap_or_default();
    let path = std::env::join_paths(std::iter::once(programs).chain(std::env::split_paths(&path)));
    let mut shell = Command::new("bash");
    shell.args(["-c", line]).current_dir(at).env("PATH", path.expect("folders of programs have plain names"));
    let done = shell.output().expect("there is a shell");
    let is_well = done.status.code().is_some_and(|status| status <= 1);
    assert!(is_well, "{line}\n{}", String::from_utf8_lossy(&done.stderr));
    String::from_utf8(done.stdout).expect("results are UTF-8")
}

/// A folder with `fixtures` in it, as a checkout has them.
///
/// # Panics
/// Where they cannot be copied.
#[must_use]
pub fn checkout() -> tempfile::TempDir {
    let checkout = tempfile::tempdir().expect("there is a place for temporary files");
    let into = checkout.path().join("fixtures");
    std::fs::create_dir(&into).expect("it is new");
    for entry in std::fs::read_dir(folder()).expect("the workspace has fixtures") {
        let file = entry.expect("their folder can be read").path();
        if let Some(name) = file.file_name().filter(|_| file.is_file()) {
            std::fs::copy(&file, into.join(name)).expect("they can be copied");
        }
    }
    checkout
}
