//! The command line between pipes, shells and people: readers that leave early, completions, manuals, names that are nearly right.

use std::path::Path;
use std::process::{Command, Stdio};

use frikan_tests::command::{run, trainer};

/// Exit status of a command whose output and messages nobody reads.
fn unread(folder: &Path, arguments: &[&str]) -> Option<i32> {
    let mut command = Command::new(trainer());
    command.current_dir(folder).args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    drop((child.stdout.take(), child.stderr.take()));
    child.wait().unwrap().code()
}

#[test]
fn a_reader_that_leaves_early_is_no_error() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("joint.toml"), "[plant.campaign]\ntrajectory_s = 1.0\n").unwrap();
    let simulate = ["simulate", "joint.toml", "--duration", "2", "-o", "real.csv", "--json", "-"];
    assert_eq!(unread(at, &simulate), Some(0));
    assert!(at.join("real.csv").exists());
    assert_eq!(unread(at, &["explain"]), Some(0));
    assert_eq!(unread(at, &["completions", "bash"]), Some(0));
    assert_eq!(
        unread(at, &["fit", "real.csv", "--joint", "absent.toml", "-o", "m.frk"]),
        Some(5),
        "its own status stays"
    );
}

#[test]
fn shells_complete_and_manuals_are_written() {
    let folder = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        let script = run(folder.path(), &["completions", shell]);
        assert!(script.status == 0 && script.output.contains("diagnose") && script.output.contains("least-effect"));
    }
    let man = run(folder.path(), &["man", "-o", "man"]);
    assert_eq!((man.status, man.messages.as_str()), (0, ""));
    let page = std::fs::read_to_string(folder.path().join("man/trainer-diagnose.1")).unwrap();
    assert!(page.contains(".TH") && page.contains("simulation"), "{page}");
    assert!(std::fs::read_to_string(folder.path().join("man/trainer.1")).unwrap().contains("diagnose"));
}

#[test]
fn names_that_are_nearly_right_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for (line, meant) in [
        ("diagnoze real.csv", "diagnose"),
        ("explain presliden", "presliding"),
        ("explain FRK-D05", "FRK-D0"),
        ("simulate joint.toml -o real.csv --effect presliden=1", "presliding"),
        ("fit real.csv -o m.frk --target cortex-m4", "did you mean `cortex-m4f`"),
    ] {
        let told = run(at, &line.split(' ').collect::<Vec<_>>());
        assert_eq!(told.status, 2, "{line}: {}", told.messages);
        assert!(told.messages.contains(meant), "{line}: {}", told.messages);
    }
}

#[test]
fn a_place_that_cannot_be_written_is_refused_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::create_dir(at.join("folder")).unwrap();
    // The recording is not there either, but nobody has looked.
    for line in [
        "fit real.csv -o nowhere/m.frk",
        "diagnose real.csv --report nowhere/d.html",
        "simulate joint.toml -o nowhere/real.csv",
        "predict m.frk real.csv -o folder",
    ] {
        let refused = run(at, &line.split(' ').collect::<Vec<_>>());
        assert_eq!(refused.status, 5, "{line}: {}", refused.messages);
        assert!(refused.messages.starts_with("nowhere/") || refused.messages.starts_with("folder: FRK-I003"));
    }
    assert_eq!(run(at, &["fit", "real.csv", "-o", "real.csv"]).status, 2);
}
