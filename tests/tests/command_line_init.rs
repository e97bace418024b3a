//! `trainer init` on columns that it does not know by their names, and on joints that report no torque.

use std::fmt::Write as _;
use std::path::Path;

use frikan_tests::command::{Run, run};
use frikan_trainer::joint::Joint;

/// A swing of a joint with Coulomb friction at 200 Hz: time, position, velocity, torque.
fn write(at: &Path, header: &str, columns: impl Fn([f64; 4]) -> String) {
    let mut text = format!("{header}\n");
    for row in 0..4000 {
        let t = f64::from(row) * 0.005;
        let (position, velocity) =
            ((0.9 * t).sin() + 0.4 * (2.3 * t).sin(), 0.9 * (0.9 * t).cos() + 0.92 * (2.3 * t).cos());
        let torque = 0.8 * (velocity / 0.01).tanh() + 0.3 * velocity + 0.02 * (41.0 * t * t).sin();
        writeln!(text, "{}", columns([t, position, velocity, torque])).unwrap();
    }
    std::fs::write(at.join("log.csv"), text).unwrap();
}

fn init(at: &Path) -> (Run, String, Joint) {
    let _ = std::fs::remove_file(at.join("joint.toml"));
    let done = run(at, &["init", "log.csv", "-o", "joint.toml"]);
    assert_eq!(done.status, 0, "{}", done.messages);
    let text = std::fs::read_to_string(at.join("joint.toml")).unwrap();
    let joint = Joint::parse(&text).unwrap();
    (done, text, joint)
}

fn check(at: &Path) -> Run {
    run(at, &["check", "log.csv", "--joint", "joint.toml"])
}

#[test]
fn columns_in_german_and_before_the_gear_are_known() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let rpm = |velocity: f64| velocity * 60.0 / std::f64::consts::TAU;
    write(at, "Zeit;Winkel;Drehzahl;Strom", |[t, q, v, torque]| format!("{t:.3};{q:.6};{:.4};{torque:.4}", rpm(v)));
    let (done, text, joint) = init(at);
    let mapped = ["time", "position", "velocity", "current"].map(|quantity| joint.columns[quantity].name.as_str());
    assert_eq!(mapped, ["Zeit", "Winkel", "Drehzahl", "Strom"], "{text}");
    assert_eq!(joint.columns["velocity"].unit.as_deref(), Some("rpm"));
    assert!(!done.messages.contains("no column"), "{}", done.messages);
    assert_eq!(check(at).status, 0, "{}", check(at).output);

    write(at, "time_s,motor_angle,torque_Nm", |[t, q, _, torque]| format!("{t:.3},{q:.6},{torque:.4}"));
    let (_, text, joint) = init(at);
    assert_eq!(joint.columns["position"].name, "motor_angle");
    assert!(text.contains("side = \"motor\"") && check(at).status == 0, "{text}");

    let counts = |q: f64| (q / std::f64::consts::TAU * 8192.0 + 4000.0).round();
    write(at, "time_s,encoder,torque_Nm", |[t, q, _, torque]| format!("{t:.3},{},{torque:.4}", counts(q)));
    let (_, text, joint) = init(at);
    assert_eq!(joint.columns["position"].unit.as_deref(), Some("count"), "{text}");
    assert_eq!(joint.drive.counts_per_turn, Some(8192.0));
}

#[test]
fn what_nothing_tells_is_listed_and_said() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write(at, "alpha;beta", |[_, _, _, torque]| format!("{torque:.4};auto"));
    let (done, text, joint) = init(at);
    assert!(joint.columns.is_empty());
    for words in ["the time", "the position or the velocity", "torque, force or current", "nothing is read by it yet"] {
        assert!(done.messages.contains(words), "{words}: {}", done.messages);
    }
    assert!(text.contains("# position = { name = \"alpha\"") && text.contains("# \"beta\""), "{text}");
    let checked = check(at);
    assert!(checked.status == 3 && checked.messages.contains("FRK-D013"), "{}", checked.messages);

    write(at, "time_s,velocity_rad_s,torque_Nm", |[t, _, v, torque]| format!("{t:.3},{v:.6},{torque:.4}"));
    let (done, _, _) = init(at);
    assert!(done.messages.contains("no column looks like the position"), "{}", done.messages);

    // What a row holds is no question of names: such a file is refused as ever, and nothing is written.
    std::fs::remove_file(at.join("joint.toml")).unwrap();
    write(at, "time_s,position_rad,torque_Nm", |[t, q, _, _]| {
        format!("{t:.3},{q:.6},{}", if t > 1.0 { "oops" } else { "1.5" })
    });
    let refused = run(at, &["init", "log.csv", "-o", "joint.toml"]);
    assert!(refused.status == 3 && refused.messages.contains("FRK-D005"), "{}", refused.messages);
    assert!(!at.join("joint.toml").exists());
}

#[test]
fn a_joint_is_not_named_after_its_file() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "time_s,position_rad,torque_Nm", |[t, q, _, torque]| format!("{t:.3},{q:.6},{torque:.4}"));
    let (_, text, joint) = init(folder.path());
    assert!(joint.name.is_none() && text.contains("# name = \"...\""), "{text}");
    // As ROS has it the recording itself names the joint.
    let header = "time_s,/joint_states/elbow/position,/joint_states/elbow/effort";
    write(folder.path(), header, |[t, q, _, torque]| format!("{t:.3},{q:.6},{torque:.4}"));
    assert_eq!(init(folder.path()).2.name.as_deref(), Some("elbow"));
}

#[test]
fn a_joint_without_torque_gets_its_actuator_proposed() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for (header, kind) in [
        ("time_s,position_rad,goal_position_rad,voltage_V,torque_enabled", "position_servo"),
        ("time_s,position_rad,reference_position_rad,reference_velocity_rad_s,feed_forward_Nm", "pd"),
        ("time_s,position_rad,duty,voltage_V,torque_enabled", "dc_motor"),
    ] {
        write(at, header, |[t, q, v, torque]| format!("{t:.3},{q:.6},{v:.6},{torque:.4},1"));
        let (done, text, joint) = init(at);
        for words in [
            "# [actuator]",
            &format!("# kind = \"{kind}\""),
            "XL330, XL320",
            "# [payload]",
            "# mass_kg",
            "docs/servos.md",
        ] {
            assert!(text.contains(words), "{words}: {text}");
        }
        assert!(done.messages.contains("[actuator]") && done.messages.contains("docs/servos.md"), "{}", done.messages);
        assert_eq!(joint.actuator, Joint::default().actuator);
        // Until it is filled in, whoever needs a torque names it.
        let fit = run(at, &["fit", "log.csv", "--joint", "joint.toml", "-o", "m.frk", "--quiet"]);
        assert!(fit.status == 3 && fit.messages.contains("FRK-D009"), "{}", fit.messages);
        assert!(fit.messages.contains("`[actuator]`") && fit.messages.contains("docs/servos.md"), "{}", fit.messages);
    }
    let explained = run(at, &["explain", "FRK-D009"]).output;
    assert!(explained.contains("`[actuator]`") && explained.contains("docs/servos.md"), "{explained}");
}
