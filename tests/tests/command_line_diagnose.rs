//! `trainer diagnose` on the command line: what it is compared with, what it advises, and bad or scarce data.

use std::path::Path;

use frikan_tests::command::{Run, run};
use serde_json::Value;

/// A small joint that is moved by `motion` only; `rate` in Hz.
fn joint(rate: f64, motion: &str) -> String {
    format!(
        "name = \"elbow\"\n[limits]\nlowest_position_rad = -1.5\nhighest_position_rad = 1.5\nvelocity_rad_s = 3\n\
         acceleration_rad_s2 = 20\n[plant]\ngravity_torque_Nm = [6.0]\nload_channel = \"none\"\n\
         [plant.friction]\nstribeck_torque_Nm = 1.0\nstribeck_velocity_rad_s = 0.1\n\
         [plant.drive]\nrate_Hz = {rate:.1}\n[plant.noise]\nkind = \"white\"\nwhite_torque_Nm = 0.1\n\
         [plant.thermal]\nsensor = false\n[plant.other_joint]\nrecorded = false\n\
         [plant.campaign]\ntrajectory_s = 6.0\n{motion}"
    )
}

const SWINGS: &str = "[[plant.campaign.trajectories]]\nmotion = { kind = \"multisine\", amplitude_rad = 1.2, \
    lowest_Hz = 0.2, highest_Hz = 0.9, speed_rad_s = 2.5, lines = 5 }\n\
    [[plant.campaign.trajectories]]\nmotion = { kind = \"triangles\", amplitude_rad = 0.8, speed_rad_s = 0.6 }\n";
const NARROW: &str = "[[plant.campaign.trajectories]]\nmotion = { kind = \"multisine\", amplitude_rad = 0.35, \
    lowest_Hz = 0.3, highest_Hz = 1.2, speed_rad_s = 2.5, lines = 5 }\n";
const REST: &str = "[[plant.campaign.trajectories]]\nmotion = { kind = \"rest\" }\n";

/// A folder with joints in motion and at rest.
fn bench() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [
        ("joint.toml", joint(250.0, SWINGS)),
        ("slower.toml", joint(180.0, SWINGS)),
        ("narrow.toml", joint(250.0, NARROW)),
        ("rest.toml", joint(250.0, REST)),
    ] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

fn simulate(folder: &Path, arguments: &str) {
    let words: Vec<&str> = ["simulate", "--quiet"].into_iter().chain(arguments.split_whitespace()).collect();
    let made = run(folder, &words);
    assert_eq!(made.status, 0, "{}", made.messages);
}

fn diagnose(folder: &Path, arguments: &str) -> Run {
    let words: Vec<&str> = ["diagnose", "--quiet"].into_iter().chain(arguments.split_whitespace()).collect();
    run(folder, &words)
}

/// Writes `to` from the rows of `from`, field by field.
fn rewrite(folder: &Path, from: &str, to: &str, change: impl Fn(&[&str]) -> String) {
    let text = std::fs::read_to_string(folder.join(from)).unwrap();
    let lines: Vec<String> = text.lines().map(|line| change(&line.split(',').collect::<Vec<_>>())).collect();
    std::fs::write(folder.join(to), lines.join("\n") + "\n").unwrap();
}

#[test]
fn a_simulation_may_be_shorter_later_or_sampled_differently() {
    let folder = bench();
    let at = folder.path();
    simulate(at, "joint.toml --effect presliding=1 --duration 48 --seed 3 -o real.csv");
    simulate(at, "joint.toml --duration 48 --seed 3 -o same.csv");
    simulate(at, "joint.toml --duration 24 --seed 4 -o shorter.csv");
    simulate(at, "slower.toml --duration 48 --seed 5 -o slower.csv");
    rewrite(at, "same.csv", "later.csv", |fields| match fields[0].parse::<f64>() {
        Ok(time) => format!("{:.4},{}", time + 1000.0, fields[1..].join(",")),
        Err(_) => fields.join(","),
    });
    for simulation in ["same.csv", "later.csv", "shorter.csv", "slower.csv"] {
        let told = diagnose(at, &format!("real.csv --simulation {simulation} --json -"));
        assert_eq!(told.status, 1, "{simulation}: {}", told.messages);
        let json: Value = serde_json::from_str(&told.output).unwrap();
        let effects: Vec<&Value> = json["findings"].as_array().unwrap().iter().map(|f| &f["effect"]).collect();
        assert_eq!(effects, ["presliding"], "{simulation}");
    }
}

#[test]
fn a_simulation_that_is_right_leaves_nothing_to_find() {
    let folder = bench();
    simulate(folder.path(), "joint.toml --duration 48 --seed 9 -o real.csv");
    simulate(folder.path(), "joint.toml --duration 48 --seed 3 -o same.csv");
    for simulation in ["same.csv", "real.csv"] {
        let told = diagnose(folder.path(), &format!("real.csv --simulation {simulation}"));
        assert_eq!((told.status, told.messages.as_str()), (0, ""), "{}", told.output);
        assert!(told.output.starts_with("Nothing is missing"), "{}", told.output);
    }
}

#[test]
fn the_improved_image_as_a_model_leaves_nothing_to_find() {
    let folder = bench();
    simulate(folder.path(), "joint.toml --effect presliding=1 --duration 48 --seed 3 -o real.csv");
    let found = diagnose(folder.path(), "real.csv -o better.frk");
    assert_eq!(found.status, 1, "{}", found.messages);
    let again = diagnose(folder.path(), "real.csv --model better.frk");
    assert_eq!(again.status, 0, "{}", again.output);
}

#[test]
fn missing_channels_rest_and_two_seconds_are_answered_clearly() {
    let folder = bench();
    let at = folder.path();
    simulate(at, "joint.toml --effect presliding=1 --duration 48 --seed 3 -o real.csv");
    simulate(at, "joint.toml --duration 2 --seed 3 -o two_seconds.csv");
    simulate(at, "rest.toml --duration 12 -o rest.csv");
    rewrite(at, "real.csv", "no_torque.csv", |fields| fields[..2].join(","));
    rewrite(at, "real.csv", "no_position.csv", |fields| format!("{},{}", fields[0], fields[2]));
    rewrite(at, "real.csv", "current.csv", |fields| fields.join(",").replace("torque_Nm", "current_A"));
    let mut text = String::new();
    for arguments in [
        "no_torque.csv",
        "no_position.csv",
        "rest.csv",
        "two_seconds.csv",
        "real.csv --simulation no_torque.csv",
        "real.csv --simulation rest.csv",
        "real.csv --simulation two_seconds.csv",
        "real.csv --simulation current.csv",
        "rest.csv --simulation real.csv",
        "real.csv absent.csv",
    ] {
        let told = diagnose(at, &format!("{arguments} -o out.frk --json out.json"));
        assert!(!at.join("out.frk").exists() && told.output.is_empty(), "{arguments}: {told:?}");
        text += &format!("{arguments}: {} {}\n", told.status, told.messages.trim_end());
    }
    insta::assert_snapshot!(text);
}

#[test]
fn advice_is_a_trajectory_within_the_limits() {
    let folder = bench();
    let at = folder.path();
    simulate(at, "narrow.toml --effect spring=2 --duration 48 --seed 3 -o real.csv");
    let told = diagnose(at, "real.csv --joint narrow.toml --advise next.csv --json -");
    assert_eq!(told.status, 1, "{}", told.messages);
    let json: Value = serde_json::from_str(&told.output).unwrap();
    let advice = &json["advice"];
    assert!(advice["expected_margin_nats"].as_f64() > advice["present_margin_nats"].as_f64(), "{advice}");
    assert!(json["findings"][0]["separate_by"].as_str().unwrap().contains("expected margin"));
    let text = std::fs::read_to_string(at.join("next.csv")).unwrap();
    let mut rows = text.lines();
    assert_eq!(rows.next(), Some("time_s,position_rad,velocity_rad_s,acceleration_rad_s2"));
    let mut before = f64::NEG_INFINITY;
    let mut reach = 0.0f64;
    for row in rows {
        let fields: Vec<f64> = row.split(',').map(|field| field.parse().unwrap()).collect();
        let [time, position, velocity, acceleration] = fields[..] else { panic!("{row}") };
        assert!(time > before && position.abs() <= 1.5 && velocity.abs() <= 3.0 && acceleration.abs() <= 20.5, "{row}");
        (before, reach) = (time, reach.max(position.abs()));
    }
    // Gravity and a spring differ only where the sine bends.
    assert!(reach > 1.2, "{reach}");
    // The recording of the advised motion goes behind the first one.
    let both = diagnose(at, "real.csv real.csv --json -");
    let json: Value = serde_json::from_str(&both.output).unwrap();
    assert_eq!((both.status, &json["schema"]), (1, &Value::from("frikan.diagnose/1")), "{}", both.messages);
}
