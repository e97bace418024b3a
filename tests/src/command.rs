//! Runs the command line as a user does.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

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
