//! `trainer diagnose` on the command line: what it is compared with, what it advises, and bad or scarce data.

use std::path::Path;

use frikan_tests::command::{Run, run};
use serde_json::Value;

/// A small joint; `rate` in Hz.
fn joint(rate: f64) -> String {
    format!(
        "name = \"elbow\"\n[limits]\nlowest_position_rad = -1.5\nhighest_position_rad = 1.5\nvelocity_rad_s = 3\n\
         acceleration_rad_s2 = 20\n[plant]\ngravity_torque_Nm = [6.0]\nload_channel = \"none\"\n\
         [plant.friction]\nstribeck_torque_Nm = 1.0\nstribeck_velocity_rad_s = 0.1\n\
         [plant.drive]\nrate_Hz = {rate:.1}\n[plant.noise]\nkind = \"white\"\nwhite_torque_Nm = 0.1\n\
         [plant.thermal]\nsensor = false\n[plant.other_joint]\nrecorded = false\n"
    )
}

/// A folder with `joint.toml` and what `simulate` makes of each list of arguments.
fn bench(recordings: &[&[&str]]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("joint.toml"), joint(250.0)).unwrap();
    std::fs::write(folder.path().join("slow.toml"), joint(180.0)).unwrap();
    for arguments in recordings {
        let made = run(folder.path(), &[&["simulate", "--quiet"], *arguments].concat());
        assert_eq!(made.status, 0, "{}", made.messages);
    }
    folder
}

/// Effects that were found, in order.
fn found(json: &str) -> Vec<String> {
    let json: Value = serde_json::from_str(json).unwrap();
    let findings = json["findings"].as_array().unwrap();
    findings.iter().map(|finding| finding["effect"].as_str().unwrap().to_owned()).collect()
}

fn rewrite(folder: &Path, from: &str, to: &str, change: impl Fn(&[&str]) -> String) {
    let text = std::fs::read_to_string(folder.join(from)).unwrap();
    let lines: Vec<String> = text.lines().map(|line| change(&line.split(',').collect::<Vec<_>>())).collect();
    std::fs::write(folder.join(to), lines.join("\n") + "\n").unwrap();
}

const REAL: &[&str] = &["joint.toml", "--effect", "load_offset=1", "-o", "real.csv"];

#[test]
fn a_simulation_may_be_shorter_later_or_sampled_differently() {
    let hidden = ["joint.toml", "--effect", "torque_offset=1", "--duration", "48", "--seed", "3", "-o", "real.csv"];
    let folder = bench(&[
        &hidden,
        &["joint.toml", "--duration", "48", "--seed", "3", "-o", "same.csv"],
        &["joint.toml", "--duration", "24", "--seed", "4", "-o", "shorter.csv"],
        &["slow.toml", "--duration", "48", "--seed", "5", "-o", "slower.csv"],
    ]);
    rewrite(folder.path(), "same.csv", "later.csv", |fields| match fields[0].parse::<f64>() {
        Ok(time) => format!("{:.4},{}", time + 1000.0, fields[1..].join(",")),
        Err(_) => fields.join(","),
    });
    for simulation in ["same.csv", "later.csv", "shorter.csv", "slower.csv"] {
        let told = run(folder.path(), &["diagnose", "real.csv", "--simulation", simulation, "--json", "-", "--quiet"]);
        assert_eq!(told.status, 1, "{simulation}: {}", told.messages);
        assert_eq!(found(&told.output), ["torque_offset"], "{simulation}");
    }
}
