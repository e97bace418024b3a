//! Sets of effects weighed by one likelihood, recording and simulation in one model.

use std::path::Path;

use frikan_tests::command::run;
use serde_json::Value;

/// A folder with the elbow of the fixtures, as it is and without noise.
fn bench() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures");
    let elbow = std::fs::read_to_string(fixtures.join("elbow.toml")).unwrap();
    let quiet = elbow.replace("white_torque_Nm = 0.1", "white_torque_Nm = 0.0\ncoloured_torque_Nm = 0.0");
    assert_ne!(quiet, elbow);
    std::fs::write(folder.path().join("joint.toml"), elbow).unwrap();
    std::fs::write(folder.path().join("quiet.toml"), quiet).unwrap();
    folder
}

fn simulate(folder: &Path, arguments: &str) {
    let words: Vec<&str> = ["simulate", "--quiet"].into_iter().chain(arguments.split_whitespace()).collect();
    let made = run(folder, &words);
    assert_eq!(made.status, 0, "{}", made.messages);
}

/// The diagnosis of a recording beside its simulation, and the image `improved.frk`.
fn diagnosed(folder: &Path, real: &str) -> Value {
    let asked = "--simulation simulated.csv --by-likelihood --json - -o improved.frk";
    let words: Vec<&str> = ["diagnose", "--quiet", real].into_iter().chain(asked.split_whitespace()).collect();
    let told = run(folder, &words);
    assert!(told.status < 2, "{}", told.messages);
    serde_json::from_str(&told.output).unwrap()
}

#[test]
fn what_the_simulation_lacks_is_named_and_what_it_has_is_not_missing() {
    let folder = bench();
    let at = folder.path();
    simulate(at, "quiet.toml --duration 30 --seed 7 -o simulated.csv");
    simulate(at, "joint.toml --duration 30 --seed 7 -o healthy.csv");
    simulate(at, "joint.toml --duration 30 --seed 7 --effect presliding=1 -o hidden.csv");
    let healthy = diagnosed(at, "healthy.csv");
    assert_eq!(healthy["verdict"], "consistent", "{:#}", healthy["findings"]);
    let hidden = diagnosed(at, "hidden.csv");
    let first = &hidden["findings"][0];
    assert_eq!(first["effect"], "presliding", "{:#}", hidden["findings"]);
    assert!(first["probability"].as_f64().unwrap() > 0.9);
}

/// What the simulation shows by itself is no finding, and yet part of what the drive gets.
#[test]
fn what_the_simulation_holds_stays_in_its_law_and_reaches_the_image() {
    let folder = bench();
    let at = folder.path();
    simulate(at, "joint.toml --effect presliding=0.5 --duration 40 --seed 3 -o real.csv");
    simulate(at, "quiet.toml --effect presliding=0.5 --duration 40 --seed 3 -o simulated.csv");
    let told = diagnosed(at, "real.csv");
    assert_eq!(told["verdict"], "consistent", "{:#}", told["findings"]);
    assert_eq!(told["given"]["holds"], serde_json::json!(["presliding"]));
    let shown = run(at, &["show", "improved.frk"]);
    assert!(shown.output.contains("effect      presliding: sum of torque_i"), "{}", shown.output);
}

/// Without friction nothing shows how softly it turns over, and the level of the joint's own is not bent by that.
#[test]
fn a_simulation_without_friction_does_not_soften_that_of_the_joint() {
    let folder = bench();
    let at = folder.path();
    let joint = std::fs::read_to_string(at.join("joint.toml")).unwrap();
    let friction = ["coulomb_torque_Nm = 2.0", "viscous_Nm_s_rad = 1.2", "stribeck_torque_Nm = 1.0"];
    let none = |text: String, line: &&str| text.replace(line, &format!("{} = 0.0", line.split_once(" = ").unwrap().0));
    std::fs::write(at.join("frictionless.toml"), friction.iter().fold(joint.clone(), none)).unwrap();
    std::fs::write(at.join("rougher.toml"), joint.replace(friction[0], "coulomb_torque_Nm = 3.0")).unwrap();
    simulate(at, "rougher.toml --duration 40 --seed 3 -o real.csv");
    simulate(at, "frictionless.toml --duration 40 --seed 7 -o simulated.csv");
    let moved = &diagnosed(at, "real.csv")["base_parameters"][0];
    assert_eq!(moved["name"], "coulomb_torque_change");
    let change = moved["value"].as_f64().unwrap();
    assert!((change - 3.0).abs() < 0.1, "{change}");
}
