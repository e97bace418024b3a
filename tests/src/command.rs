//! Runs the command line as a user does.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

use crate::fixtures::folder;

/// The program `trainer`: the one that `FRIKAN_TRAINER` names, else that of this build, built first where it is not there yet.
///
/// # Panics
/// When it cannot be built.
pub fn trainer() -> &'static Path {
    static PROGRAM: OnceLock<PathBuf> = OnceLock::new();
    PROGRAM.get_or_init(|| {
        if let Some(program) = std::env::var_os("FRIKAN_TRAINER") {
            return program.into();
        }
        let mut build = Command::new(env!("CARGO"));
        build.args(["build", "--quiet", "--package", "frikan-trainer", "--bin", "trainer"]);
        let this = std::env::current_exe().expect("a program has a path");
        let below_target = |folder: &&Path| !folder.ends_with("deps");
        let profile = this.ancestors().skip(1).find(below_target).expect("it lies in target/PROFILE[/deps]").to_owned();
        if profile.ends_with("release") {
            build.arg("--release");
        }
        assert!(build.status().is_ok_and(|status| status.success()), "the command line cannot be built");
        profile.join("trainer")
    })
}

/// What one run brought.
#[derive(Debug)]
pub struct Run {
    /// Exit status.
    pub status: i32,
    /// Standard output.
    pub output: String,
    /// Standard error.
    pub messages: String,
}

/// Runs `trainer` in `folder` with `arguments`.
///
/// # Panics
/// When it cannot be started or is killed.
pub fn run(folder: &Path, arguments: &[&str]) -> Run {
    let Output { status, stdout, stderr } =
        Command::new(trainer()).current_dir(folder).args(arguments).output().expect("trainer starts");
    Run {
        status: status.code().expect("trainer ends by itself"),
        output: String::from_utf8_lossy(&stdout).into_owned(),
        messages: String::from_utf8_lossy(&stderr).into_owned(),
    }
}

/// Runs `trainer` in `folder` with a line of words and returns its exit status, 0 or 1: a diagnosis that finds something ends with 1.
///
/// # Panics
/// Where it ends with another.
pub fn called(folder: &Path, line: &str) -> i32 {
    let words: Vec<&str> = line.split_whitespace().collect();
    let done = run(folder, &words);
    assert!(done.status <= 1, "{line}: {}", done.messages);
    done.status
}

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
