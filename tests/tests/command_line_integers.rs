//! `trainer fit --target` for a drive without floating-point unit: a table of integers in the counts of the drive, proved by `verify`.

use std::path::Path;

use frikan_tests::command::{Run, run};
use frikan_tests::fixtures::separated_recording;
use frikan_tests::paper::JOINTS;
use serde_json::Value;

/// A drive that counts thousandths of a rad/s and of 50 N m.
const COUNTS: &str = "[drive]\nvelocity_count_rad_s = 0.001\ntorque_count_Nm = 0.05\n";

fn bench() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("train.csv"), separated_recording(JOINTS[0], 600, 1)).unwrap();
    std::fs::write(folder.path().join("counts.toml"), COUNTS).unwrap();
    folder
}

fn fit(at: &Path, more: &[&str]) -> Run {
    run(at, &[&["fit", "train.csv", "--quiet", "-o", "m.frk", "--target", "cortex-m0plus"], more].concat())
}

fn json(at: &Path, arguments: &[&str]) -> Value {
    let done = run(at, arguments);
    assert_eq!(done.status, 0, "{}", done.messages);
    serde_json::from_str(&done.output).unwrap()
}

#[test]
fn a_drive_without_floating_point_unit_gets_a_table_of_integers() {
    let folder = bench();
    let at = folder.path();
    let done = fit(at, &["--json", "m.json", "--report", "m.html"]);
    assert_eq!((done.status, done.messages.as_str()), (0, ""));
    assert!(done.output.contains("integers    a table of ") && done.output.contains("in floats a "), "{}", done.output);
    let fitted: Value = serde_json::from_slice(&std::fs::read(at.join("m.json")).unwrap()).unwrap();
    let page = std::fs::read_to_string(at.join("m.html")).unwrap();
    assert!(page.contains("In integers on cortex-m0plus") && page.contains("A table of "));
    let integers = &fitted["integers"];
    println!("{integers:#}");
    assert_eq!((&integers["target"], &fitted["inputs"][0]), (&Value::from("cortex-m0plus"), &Value::from("velocity")));
    assert!(integers["cells"].as_u64() <= Some(128));
    for count in ["velocity_count", "torque_count"] {
        assert!(integers[count]["format"].as_str().is_some_and(|format| format.starts_with('Q')), "{count}");
    }
    // Every count of 16 bits, and close to the law at each.
    assert!((16_000..=65_536).contains(&integers["error"]["counts"].as_u64().unwrap()));
    assert!(integers["error"]["share"].as_f64().unwrap() < 0.01);
    assert!(integers["in_floats"]["instructions"][0].as_u64() > integers["instructions"].as_u64());
    assert!(fitted["train"]["r2"].as_f64().unwrap() > 0.999);
    assert!(run(at, &["show", "m.frk"]).output.contains("integer table of"));

    let verified = json(at, &["verify", "m.frk", "--json"]);
    let integers = &verified["integers"];
    assert_eq!(integers["steps"], integers["steps_equal"]);
    assert!(integers["steps"].as_u64() > Some(16_000));
    assert_eq!(integers["velocity_count"], fitted["integers"]["velocity_count"]["value"]);
    let text = run(at, &["verify", "m.frk"]).output;
    assert!(text.contains("steps in counts of"), "{text}");
}

#[test]
fn the_counts_are_those_of_the_joint_file() {
    let folder = bench();
    let at = folder.path();
    let done = fit(at, &["--joint", "counts.toml", "--json", "-"]);
    assert_eq!(done.status, 0, "{}", done.messages);
    let integers = serde_json::from_str::<Value>(&done.output).unwrap()["integers"].take();
    assert!((integers["velocity_count"]["value"].as_f64().unwrap() - 0.001).abs() < 1e-9);
    assert_eq!(integers["velocity_count"]["format"], Value::Null);
    assert!(integers["error"]["largest"].as_f64().unwrap() < 0.1);
    let verified = json(at, &["verify", "m.frk", "--joint", "counts.toml", "--json"])["integers"].take();
    assert_eq!(verified["steps"], verified["steps_equal"]);
    let export = |joint: &str| run(at, &["export", "m.frk", "--to", "c", "--joint", joint, "-o", "m.c"]);
    assert_eq!(export("counts.toml").status, 0);
    assert!(std::fs::read_to_string(at.join("m.h")).unwrap().contains("in counts of 0.05 N m and of 0.001 rad/s"));
    std::fs::write(at.join("others.toml"), COUNTS.replace("0.05", "0.07")).unwrap();
    for refused in [run(at, &["verify", "m.frk", "--joint", "others.toml"]), export("others.toml")] {
        assert!(refused.status == 2 && refused.messages.contains("not for these counts"), "{}", refused.messages);
    }
}

#[test]
fn what_a_table_of_integers_cannot_do_is_told() {
    let folder = bench();
    let at = folder.path();
    let refused = fit(at, &["--inputs", "velocity,temperature"]);
    assert!(refused.status == 2 && refused.messages.contains("the velocity alone"), "{}", refused.messages);
    std::fs::write(at.join("fine.toml"), COUNTS.replace("0.05", "0.0001")).unwrap();
    let refused = fit(at, &["--joint", "fine.toml"]);
    assert!(refused.status == 2 && refused.messages.contains("torque_count_Nm"), "{}", refused.messages);
    assert!(!at.join("m.frk").exists());
}
