//! The command line on bad input: one clear message, the promised exit status, nothing left behind.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::Path;

use frikan_tests::command::run;

const HEADER: &str = "time_s,position_rad,torque_Nm\n";

/// A recording of a swinging joint; `change` may replace a row.
fn swinging(rows: usize, change: impl Fn(usize) -> Option<String>) -> String {
    let mut text = HEADER.to_owned();
    for row in 0..rows {
        let time = row as f64 * 0.004;
        let line = format!("{time:.4},{:.6},{:.4}", (2.0 * time).sin(), 2.0 * (2.0 * time).cos().signum());
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{}", change(row).unwrap_or(line));
    }
    text
}

/// Runs a fit that has to be refused and returns its exit status and message.
fn refusal(folder: &Path) -> String {
    let fit = run(folder, &["fit", "arm.csv", "-o", "out.frk", "--json", "out.json", "--quiet"]);
    assert!(!folder.join("out.frk").exists() && !folder.join("out.json").exists(), "{fit:?}");
    let left: Vec<_> = std::fs::read_dir(folder).unwrap().collect();
    assert!(left.len() <= 1, "{left:?}");
    assert_eq!(fit.output, "");
    format!("{} {}", fit.status, fit.messages)
}

fn refused(text: &str) -> String {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("arm.csv"), text).unwrap();
    refusal(folder.path())
}

#[test]
fn bad_recordings_are_refused_with_their_place() {
    let at_100 = |line: &str| {
        let line = line.to_owned();
        swinging(1000, move |row| (row == 98).then(|| line.clone()))
    };
    let constant: String = (0..1000).fold(HEADER.to_owned(), |text, row| {
        format!("{text}{:.4},{:.6},2.0\n", row as f64 * 0.004, row as f64 * 0.002)
    });
    let cases = [
        ("missing column", "torque_Nm\n".to_owned() + &"1.5\n".repeat(500)),
        ("no actuator", swinging(1000, |_| None).replace("torque_Nm", "note")),
        ("text in a number", at_100("0.392,oops,1.0")),
        ("not a number", at_100("0.392,0.5,NaN")),
        ("time backwards", at_100("0.100,0.5,1.0")),
        ("empty file", String::new()),
        ("ten rows", swinging(10, |_| None)),
        ("wrong unit", swinging(1000, |_| None).replace("torque_Nm", "torque_lbft")),
        ("constant velocity", constant),
        ("constant velocity, separated", "velocity_rad_s,friction_torque_Nm\n".to_owned() + &"0.5,2\n".repeat(500)),
    ];
    let mut text = String::new();
    for (name, recording) in cases {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{name}: {}", refused(&recording).trim_end());
    }
    insta::assert_snapshot!(text);
}

#[test]
fn a_folder_a_missing_file_and_a_missing_target_folder_are_input_and_output() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("arm.csv")).unwrap();
    assert!(refusal(folder.path()).starts_with("5 arm.csv: FRK-I003"));
    std::fs::remove_dir(folder.path().join("arm.csv")).unwrap();
    assert!(refusal(folder.path()).starts_with("5 arm.csv: FRK-I002"));
    let text = frikan_tests::fixtures::separated_recording(frikan_tests::paper::JOINTS[0], 300, 1);
    std::fs::write(folder.path().join("arm.csv"), text).unwrap();
    let fit = run(folder.path(), &["fit", "arm.csv", "-o", "absent/out.frk", "--json", "out.json", "--quiet"]);
    assert_eq!(fit.status, 5, "{}", fit.messages);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}

#[test]
fn a_line_of_a_gigabyte_is_refused_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let mut file = std::fs::File::create(folder.path().join("arm.csv")).unwrap();
    file.write_all(HEADER.as_bytes()).unwrap();
    // A hole in the file reads as zeros and takes no room on the disk.
    file.set_len(1 << 30).unwrap();
    drop(file);
    assert!(refusal(folder.path()).starts_with("3 arm.csv:2: FRK-D003"), "{}", refusal(folder.path()));
}

#[test]
fn wrong_usage_is_2() {
    let folder = tempfile::tempdir().unwrap();
    let text = frikan_tests::fixtures::separated_recording(frikan_tests::paper::JOINTS[0], 300, 1);
    std::fs::write(folder.path().join("arm.csv"), text).unwrap();
    for arguments in [
        &["fit", "arm.csv"][..],
        &["fit", "arm.csv", "-o", "m.frk", "--inputs", "velocity,magnetism"],
        &["fit", "arm.csv", "-o", "m.frk", "--rate", "-1"],
        &["fit", "arm.csv", "-o", "m.frk", "--l1", "-1"],
        &["fit", "arm.csv", "-o", "m.frk", "--restarts", "0"],
        &["fit", "arm.csv", "-o", "m.frk", "--network", "[1,five,1]"],
        &["fit", "arm.csv", "-o", "m.frk", "--network", "[2,5,1]"],
        &["verify", "arm.csv", "--target", "host", "--nonsense"],
        &["nonsense"],
    ] {
        assert_eq!(run(folder.path(), arguments).status, 2, "{arguments:?}");
    }
    let no_image = run(folder.path(), &["show", "arm.csv"]);
    assert_eq!(no_image.status, 3);
    assert!(no_image.messages.contains("FRK-D020"), "{}", no_image.messages);
}

#[test]
fn results_do_not_go_over_what_was_read() {
    let folder = tempfile::tempdir().unwrap();
    let file = |name: &str| folder.path().join(name);
    std::fs::write(file("arm.csv"), swinging(1000, |_| None)).unwrap();
    let joint = "[actuator]\nkind = \"pd\"\n";
    std::fs::write(file("out.actuator.toml"), joint).unwrap();
    // The constants of the actuator go beside the image, where the joint's own file is.
    let fit = run(folder.path(), &["fit", "arm.csv", "--joint", "out.actuator.toml", "-o", "out.frk", "--quiet"]);
    assert_eq!(fit.status, 2, "{}", fit.messages);
    assert!(fit.messages.contains("this file is also an input"), "{}", fit.messages);
    assert_eq!(std::fs::read_to_string(file("out.actuator.toml")).unwrap(), joint);
    let check = run(folder.path(), &["check", "arm.csv", "--json", "arm.csv"]);
    assert!(check.status == 2 && check.output.is_empty(), "{}", check.messages);
    assert!(std::fs::read_to_string(file("arm.csv")).unwrap().starts_with(HEADER));
}
