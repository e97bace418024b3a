//! A fleet from its plan to its table: killed and failing tasks, the same bytes again, the joint that differs.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use frikan_tests::command::{run, trainer};
use serde_json::Value;

/// Healthy joints: their friction over that of the first.
const SIBLINGS: [f64; 11] = [1.0, 0.97, 1.03, 0.94, 1.05, 0.99, 1.01, 0.96, 1.04, 1.02, 0.98];

/// Coulomb and viscous friction times `scale`, with noise from a seed.
fn recording(scale: f64, seed: u32) -> String {
    let mut text = String::from("velocity_rad_s,friction_torque_Nm\n");
    let mut state = seed.wrapping_mul(2_654_435_761).wrapping_add(1);
    for row in 0..200 {
        let velocity = (f64::from(row) - 99.5) / 100.0;
        // Uniform draws of a congruential generator (Knuth) do for noise.
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let noise = 0.08 * (f64::from(state >> 8) / f64::from(1 << 24) - 0.5);
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{velocity},{:.4}", scale * (2.0 * velocity.signum() + 0.6 * velocity) + noise);
    }
    text
}

/// A folder with siblings, one joint that rubs (`rubs`), and one whose recording cannot be read (`torn`).
fn bench() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).unwrap();
    for (index, scale) in SIBLINGS.iter().enumerate() {
        write(&format!("joint{index:02}_2025-03-01.csv"), &recording(*scale, index as u32));
    }
    write("rubs_2025-03-01.csv", &recording(2.2, 99));
    write("torn_2025-03-01.csv", "velocity_rad_s,friction_torque_Nm\n0.1,oops\n");
    folder
}

fn result(folder: &Path, index: usize) -> Vec<u8> {
    std::fs::read(folder.join(format!("tasks.results/{index:06}.json"))).unwrap()
}

#[test]
fn a_fleet_is_fitted_task_by_task_and_the_joint_that_differs_is_flagged() {
    let bench = bench();
    let at = bench.path();
    let planned = run(at, &["plan", ".", "-o", "tasks.jsonl"]);
    assert_eq!(planned.status, 0, "{}", planned.messages);
    assert!(planned.messages.contains("hq submit --array 0-12") && planned.messages.contains("sbatch --array=0-12"));
    let tasks = std::fs::read_to_string(at.join("tasks.jsonl")).unwrap();
    assert_eq!(tasks.lines().count(), 13);

    let task = |index: usize, more: &[&str]| {
        run(at, &[&["run", "--tasks", "tasks.jsonl", "--index", &index.to_string()], more].concat())
    };
    // A task that is killed leaves its result whole or not at all.
    let mut killed = Command::new(trainer());
    killed.current_dir(at).args(["run", "--tasks", "tasks.jsonl", "--index", "0"]);
    let mut killed = killed.spawn().unwrap();
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert!(!at.join("tasks.results/000000.json").exists());
    for index in 0..12 {
        let done = task(index, &["--threads", "1"]);
        assert_eq!(done.status, 0, "{}", done.messages);
    }
    let failed = task(12, &[]);
    assert_eq!(failed.status, 3);
    assert!(failed.messages.starts_with("FRK-D") && failed.messages.contains("torn"), "{}", failed.messages);

    let before = result(at, 0);
    assert_eq!(task(0, &["--force"]).status, 0);
    assert!(result(at, 0) == before, "again, with all threads, and not a byte differs");
    std::fs::remove_file(at.join("joint00_2025-03-01.csv")).unwrap();
    assert_eq!(task(0, &[]).status, 0, "what is done is not done again");
    assert_eq!(task(13, &[]).status, 2);

    std::fs::remove_file(at.join("tasks.results/000003.json")).unwrap();
    let gathered = run(at, &["gather", "--tasks", "tasks.jsonl", "-o", "table"]);
    assert_eq!(gathered.status, 1, "{}", gathered.messages);
    let fleet: Value = serde_json::from_slice(&std::fs::read(at.join("table/fleet.json")).unwrap()).unwrap();
    assert_eq!(fleet["schema"], "frikan.fleet/1");
    let joints = fleet["joints"].as_array().unwrap();
    let outliers: Vec<&str> =
        joints.iter().filter(|joint| joint["outlier"] == true).map(|joint| joint["joint"].as_str().unwrap()).collect();
    assert_eq!((joints.len(), outliers), (11, vec!["rubs"]), "{}", gathered.output);
    let unfitted: Vec<_> = fleet["unfitted"].as_array().unwrap().iter().map(|task| &task["joint"]).collect();
    assert_eq!(unfitted, ["joint03", "torn"]);
    assert_eq!(fleet["unfitted"][1]["error"]["code"], "FRK-D002");
    assert!(gathered.output.contains("rubs: friction") && gathered.output.contains("above its siblings"));
    assert!(gathered.output.contains("trainer run --index 3"), "{}", gathered.output);
    let page = std::fs::read_to_string(at.join("table/fleet.html")).unwrap();
    assert!(page.contains("rubs"));
    // It loads nothing from anywhere; the charts' source says where it comes from.
    assert!(!["src=\"http", "href=\"http", "url(http", "@import"].iter().any(|load| page.contains(load)));

    let csv = std::fs::read_to_string(at.join("table/joints.csv")).unwrap();
    let mut rows = csv::Reader::from_reader(csv.as_bytes());
    let column = |name: &str| csv.lines().next().unwrap().split(',').position(|own| own == name).expect(name);
    let rows: Vec<csv::StringRecord> = rows.records().map(|row| row.unwrap()).collect();
    assert_eq!(rows.len(), 13);
    let rubs = rows.iter().find(|row| &row[column("joint")] == "rubs").unwrap();
    let coulomb: f64 = rubs[column("coulomb_torque_Nm")].parse().unwrap();
    assert!((coulomb - 4.4).abs() < 0.1, "{coulomb}");
    assert_eq!(&rows[12][column("status")], "failed");
    // The table is a recording like any other to whatever reads Parquet; the trainer does.
    let parquet = std::fs::read(at.join("table/joints.parquet")).unwrap();
    assert!(parquet.starts_with(b"PAR1") && parquet.ends_with(b"PAR1"));
    let again = run(at, &["gather", "--tasks", "tasks.jsonl", "-o", "table"]);
    assert_eq!(again.output, gathered.output);
    assert!(std::fs::read(at.join("table/joints.parquet")).unwrap() == parquet);
}

#[test]
fn a_list_that_is_none_is_refused_with_its_line() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("tasks.jsonl"), "{}\n").unwrap();
    for arguments in
        [&["run", "--tasks", "tasks.jsonl", "--index", "0"][..], &["gather", "--tasks", "tasks.jsonl", "-o", "t"]]
    {
        let refused = run(at, arguments);
        assert_eq!(refused.status, 3);
        assert!(refused.messages.starts_with("tasks.jsonl:1: FRK-D044: "), "{}", refused.messages);
    }
}
