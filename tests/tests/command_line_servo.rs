//! Joints that report no torque: compared with a simulation by what they were commanded and where they went.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

use frikan_tests::command::run;
use serde_json::Value;

/// A pendulum under a PD command of 2 kHz, logged every 4 ms by an encoder of 16 bits: friction of 0.5 N m, and what the gear turns into
/// friction of the torque that it carries. Written apart from the program's own plant.
fn log(at: &Path, name: &str, load: f64, phase: f64) {
    const STEP_S: f64 = 5e-4;
    let waves = [(0.6, 0.5), (0.35, 1.3), (0.15, 2.9), (0.05, 5.3)].map(|(a, w): (f64, f64)| (a, w, phase * (1.0 + w)));
    let reference = |t: f64| waves.iter().map(|(a, w, p)| a * (w * t + p).sin()).sum::<f64>();
    let rate = |t: f64| waves.iter().map(|(a, w, p)| a * w * (w * t + p).cos()).sum::<f64>();
    let (mut q, mut v) = (reference(0.0), rate(0.0));
    let mut text = "time_s,position_rad,reference_position_rad,reference_velocity_rad_s\n".to_owned();
    for i in 0..80_000 {
        let t = f64::from(i) * STEP_S;
        if i % 8 == 0 {
            let count = TAU / 65536.0;
            writeln!(text, "{t:.4},{:.9},{:.9},{:.9}", (q / count).round() * count, reference(t), rate(t)).unwrap();
        }
        let torque = 40.0 * (reference(t) - q) + 1.5 * (rate(t) - v);
        let friction = (0.5 + load * torque.abs()) * (v / 0.005).tanh() + 0.08 * v;
        v += STEP_S * (torque - friction - 1.2 * q.sin()) / 0.05;
        q += STEP_S * v;
    }
    std::fs::write(at.join(name), text).unwrap();
}

/// What a diagnosis of `real.csv` beside `simulation.csv` finds, each finding with what may stand in for it.
fn found(at: &Path, joint: &str) -> (Value, Vec<Vec<String>>) {
    std::fs::write(at.join("joint.toml"), joint).unwrap();
    let words = "diagnose real.csv --simulation simulation.csv --joint joint.toml --json told.json --quiet";
    let told = run(at, &words.split(' ').collect::<Vec<_>>());
    assert!(told.status <= 1, "{}", told.messages);
    let json: Value = serde_json::from_str(&std::fs::read_to_string(at.join("told.json")).unwrap()).unwrap();
    let name = |value: &Value| value["effect"].as_str().unwrap().to_owned();
    let set = |finding: &Value| {
        std::iter::once(name(finding)).chain(finding["alternatives"].as_array().unwrap().iter().map(name)).collect()
    };
    let sets = json["findings"].as_array().unwrap().iter().map(set).collect();
    (json, sets)
}

const KNOWN: &str = "[actuator]\nkind = \"pd\"\nkp_Nm_rad = 40\nkd_Nms_rad = 1.5\n";

#[test]
fn what_a_simulation_of_a_commanded_joint_leaves_out_is_named_from_positions() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    log(at, "simulation.csv", 0.0, 0.3);
    // Recordings without any noise: what the encoder rounds is all that the two sides differ by.
    let healthy = [0.8, 1.7, 2.9, 4.1].map(|phase| {
        log(at, "real.csv", 0.0, phase);
        let (json, sets) = found(at, KNOWN);
        assert_eq!(json["actuator"]["kp_Nm_rad"], 40.0);
        sets
    });
    assert!(healthy.iter().filter(|sets| !sets.is_empty()).count() <= 1, "{healthy:?}");

    log(at, "real.csv", 0.2, 0.8);
    let (_, sets) = found(at, KNOWN);
    assert!(sets.iter().flatten().any(|name| name == "load_friction"), "{sets:?}");
}
