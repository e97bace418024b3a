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

/// The diagnosis of a recording beside its simulation.
fn diagnosed(folder: &Path, real: &str) -> Value {
    let words = ["diagnose", "--quiet", real, "--simulation", "simulated.csv", "--by-likelihood", "--json", "-"];
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
