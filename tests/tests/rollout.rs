//! The simulated joint under recorded commands, by the command line.

use std::path::Path;

use frikan_tests::command::{called, run};
use frikan_tests::table::columns;
use serde_json::Value;

const FIXTURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures");

fn json(path: &Path) -> Value {
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// The elbow of the fixtures under its recorded torque, put back every half second, with the image that was fitted to another recording.
#[test]
fn the_elbow_moves_as_it_was_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    called(
        at,
        &format!(
            "rollout {FIXTURES}/elbow.frk {FIXTURES}/elbow-test.csv --joint {FIXTURES}/elbow.toml -o out.csv --json told.json --quiet"
        ),
    );
    let told = json(&at.join("told.json"));
    assert_eq!((told["schema"].as_str(), told["unit"].as_str()), (Some("frikan.rollout/1"), Some("rad")));
    let rows = columns(&at.join("out.csv"), ["position_error_rad", "simulated_position_rad"]);
    assert_eq!(told["n"], rows.len());
    let mae = rows.iter().map(|[error, _]| error.abs()).sum::<f64>() / rows.len() as f64;
    assert!((mae - told["position"]["mae"].as_f64().unwrap()).abs() < 1e-6 * mae);
    assert!(mae < 0.02, "{told}");
}

#[test]
fn a_constant_that_nothing_tells_is_asked_for_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("joint.toml"), "[actuator]\nkind = \"pd\"\nkp_Nm_rad = 20\n").unwrap();
    let refused = run(
        at,
        &["rollout", &format!("{FIXTURES}/elbow.frk"), &format!("{FIXTURES}/elbow.csv"), "--joint", "joint.toml"],
    );
    assert_eq!(refused.status, 3);
    assert!(
        refused.messages.contains("FRK-D014") && refused.messages.contains("actuator.kd_Nms_rad"),
        "{}",
        refused.messages
    );
}
