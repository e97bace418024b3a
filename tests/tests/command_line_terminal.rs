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
        "init real.csv -o nowhere/joint.toml",
        "show m.frk --json nowhere/m.json",
        "verify m.frk --json nowhere/v.json",
        "loop joint.toml -o nowhere/trace.csv",
        "export m.frk --to c -o nowhere/m.c",
        "plan recordings -o nowhere/tasks.jsonl",
        "gather --tasks tasks.jsonl --json nowhere/fleet.json -o fleet",
        "arm real.csv --urdf arm.urdf --json nowhere/arm.json -o arm",
    ] {
        let refused = run(at, &line.split(' ').collect::<Vec<_>>());
        assert_eq!(refused.status, 5, "{line}: {}", refused.messages);
        assert!(refused.messages.starts_with("nowhere/") || refused.messages.starts_with("folder: FRK-I003"));
    }
    assert_eq!(run(at, &["fit", "real.csv", "-o", "real.csv"]).status, 2);
}

#[test]
fn a_folder_that_cannot_be_made_is_refused_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("file"), "").unwrap();
    for line in ["arm real.csv --urdf arm.urdf -o file", "gather --tasks tasks.jsonl -o file/there"] {
        let refused = run(folder.path(), &line.split(' ').collect::<Vec<_>>());
        assert_eq!(refused.status, 5, "{line}: {}", refused.messages);
        assert!(refused.messages.starts_with("file: FRK-I001"), "{line}: {}", refused.messages);
    }
}

/// Flags go before the environment, that before the file, that before defaults; the JSON tells what was in force, and from where.
#[test]
fn options_come_from_flags_environment_file_and_defaults_in_this_order() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for name in ["stribeck.csv", "elbow.toml"] {
        std::fs::copy(frikan_tests::fixtures::folder().join(name), at.join(name)).unwrap();
    }
    std::fs::write(
        at.join("trainer.toml"),
        "quiet = true\n[check]\njson = \"file.json\"\n[simulate]\nduration = 2\nseed = 3\n",
    )
    .unwrap();
    let options = |variables: &[(&str, &str)], line: &str, json: &str| -> serde_json::Value {
        let mut command = Command::new(trainer());
        command.current_dir(at).args(line.split(' ')).envs(variables.iter().copied());
        let done = command.output().unwrap();
        assert!(done.status.success(), "{line}: {}", String::from_utf8_lossy(&done.stderr));
        assert!(done.stderr.is_empty(), "quiet by the file");
        let text = std::fs::read_to_string(at.join(json)).unwrap_or_else(|error| panic!("{line}: {error}"));
        serde_json::from_str::<serde_json::Value>(&text).unwrap()["configuration"].clone()
    };
    let by_file = options(&[], "check stribeck.csv", "file.json");
    assert_eq!(by_file["json"], serde_json::json!({ "value": "file.json", "from": "file" }));
    assert_eq!(by_file["quiet"], serde_json::json!({ "value": true, "from": "file" }));
    assert_eq!(by_file["recordings"], serde_json::json!({ "value": ["stribeck.csv"], "from": "command line" }));
    let variable = [("FRIKAN_CHECK_JSON", "environment.json")];
    assert_eq!(options(&variable, "check stribeck.csv", "environment.json")["json"]["from"], "environment");
    assert_eq!(options(&variable, "check stribeck.csv --json flag.json", "flag.json")["json"]["from"], "command line");
    let rows = |line: &str| {
        let done = run(at, &line.split(' ').collect::<Vec<_>>());
        assert_eq!((done.status, done.messages.as_str()), (0, ""), "{line}");
        std::fs::read_to_string(at.join("real.csv")).unwrap().lines().count()
    };
    let short = rows("simulate elbow.toml -o real.csv");
    assert!(rows("simulate elbow.toml -o real.csv --duration 4") > 3 * short / 2);
    std::fs::write(at.join("trainer.toml"), "[simulate]\ndurations = 2\n").unwrap();
    let refused = run(at, &["simulate", "elbow.toml", "-o", "real.csv"]);
    assert_eq!(refused.status, 2);
    assert!(
        refused.messages.contains("trainer.toml") && refused.messages.contains("did you mean `duration`"),
        "{}",
        refused.messages
    );
}

#[test]
fn a_dry_run_reads_what_there_is_and_writes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::copy(frikan_tests::fixtures::folder().join("stribeck.csv"), at.join("stribeck.csv")).unwrap();
    for line in ["fit stribeck.csv -o m.frk --dry-run", "diagnose stribeck.csv -o m.frk --dry-run"] {
        let told = run(at, &line.split(' ').collect::<Vec<_>>());
        assert_eq!(told.status, 0, "{line}: {}", told.messages);
        assert!(
            told.output.contains("would read   stribeck.csv, ") && told.output.contains("would write  m.frk"),
            "{line}: {}",
            told.output
        );
    }
    assert_eq!(std::fs::read_dir(at).unwrap().count(), 1);
    assert_eq!(run(at, &["fit", "absent.csv", "-o", "m.frk", "--dry-run"]).status, 5);
}

/// Whether anything is coloured (SGR, `ESC [ ... m`) of what a terminal is shown.
fn is_coloured(folder: &Path, line: &str, no_color: Option<&str>) -> bool {
    let mut terminal = Command::new("script");
    terminal.current_dir(folder).args(["-qec", &format!("{} {line}", trainer().display()), "/dev/null"]);
    terminal.env("TERM", "xterm").env_remove("NO_COLOR").envs(no_color.map(|value| ("NO_COLOR", value)));
    let shown = String::from_utf8_lossy(&terminal.output().unwrap().stdout).into_owned();
    assert!(!shown.is_empty(), "{line}");
    let mut sequences = shown.split("\x1b[").skip(1);
    sequences.any(|rest| rest.trim_start_matches(|c: char| c.is_ascii_digit() || c == ';').starts_with('m'))
}

#[test]
fn colours_respect_no_color() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(frikan_tests::fixtures::folder().join("elbow.csv"), folder.path().join("elbow.csv")).unwrap();
    assert!(is_coloured(folder.path(), "diagnoze", None), "on a terminal there are colours to leave out");
    for line in ["diagnoze", "--help", "check elbow.csv"] {
        assert!(!is_coloured(folder.path(), line, Some("1")), "{line}");
    }
}
