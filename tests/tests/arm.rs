//! `trainer arm`: a simulated arm of six axes whose bodies, rotors and friction are known, as its user sees it.

use std::path::Path;

use frikan_tests::arm::{
    BOXES, COULOMB, JOINTS, LIMITS, LOAD, NOISE, SIX_AXES, VISCOUS, evaluate, numbers, obstacles, point_to_point,
    recorded, solid_robot, tones,
};
use frikan_tests::command::run;
use frikan_trainer::arm::chain::Chain;
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};
use serde_json::Value;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

fn constant(joint: &Value, name: &str) -> f64 {
    let found = joint["parameters"].as_array().unwrap().iter().find(|parameter| parameter["name"] == name);
    number(&found.unwrap_or_else(|| panic!("no {name}: {joint}"))["value"])
}

fn write(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).unwrap();
}

/// Masses as a user knows them: some too large, some too small.
fn as_drawn(urdf: &str) -> String {
    urdf.replace(r#"mass value="13""#, r#"mass value="16""#).replace(r#"mass value="4""#, r#"mass value="3.2""#)
}

#[test]
fn an_arm_of_six_axes_comes_back_with_the_friction_of_each() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write(at, "arm.urdf", &as_drawn(SIX_AXES));
    write(at, "train.csv", &recorded(&tones(60.0, 3), 1));
    write(at, "test.csv", &recorded(&point_to_point(10, 9), 2));
    let words = ["arm", "train.csv", "--urdf", "arm.urdf", "--test", "test.csv", "-o", "found", "--quiet", "--split"];
    let done = run(at, &words);
    assert_eq!(done.status, 0, "{}{}", done.output, done.messages);
    let arm: Value = serde_json::from_slice(&std::fs::read(at.join("found/arm.json")).unwrap()).unwrap();
    assert_eq!(arm["schema"], "frikan.arm/1");

    let numbers = numbers();
    let parameters = arm["base_parameters"].as_array().unwrap();
    let determined = parameters.iter().filter(|parameter| parameter["determined"] == true);
    for parameter in determined.clone() {
        let wanted = evaluate(parameter["expression"].as_str().unwrap(), &numbers);
        let found = number(&parameter["value"]);
        assert!((found - wanted).abs() < 0.05 * wanted.abs(), "{parameter}: {wanted}");
    }
    // Rotors, and first moments of the heavy links, at least.
    assert!(determined.count() >= 8, "{parameters:?}");

    for (joint, found) in arm["joints"].as_array().unwrap().iter().enumerate() {
        let name = found["name"].as_str().unwrap();
        let [coulomb, viscous] = ["coulomb_torque", "viscous_coefficient"].map(|name| constant(found, name));
        assert!((coulomb / COULOMB[joint] - 1.0).abs() < 0.03, "{name}: {coulomb} N m, {} is true", COULOMB[joint]);
        assert!((viscous / VISCOUS[joint] - 1.0).abs() < 0.03, "{name}: {viscous}, {} is true", VISCOUS[joint]);
        let load = &found["load_friction"];
        assert_eq!(load.is_null(), LOAD[joint] == 0.0, "{name}: {load}");
        if LOAD[joint] > 0.0 {
            assert!((number(&load["value"]) / LOAD[joint] - 1.0).abs() < 0.15, "{name}: {load}");
            assert_eq!(found["inputs"], serde_json::json!(["velocity", "load"]));
        }
        let test = &found["test"][0];
        let error = number(&test["moving"]["rmse"]) / NOISE[joint];
        assert!(error < 1.1, "{name}: {error} times the noise on a fresh motion");
        assert!(at.join("found").join(found["image"].as_str().unwrap()).exists());
    }
    assert_eq!(arm["joints"].as_array().unwrap().len(), JOINTS);

    // One joint by itself, with the torque that the arm's bodies make of its motion.
    let split =
        ["diagnose", "found/train-elbow.csv", "--joint", "found/elbow.toml", "--model", "found/elbow.frk", "--quiet"];
    let alone = run(at, &split);
    assert_eq!(alone.status, 0, "{}{}", alone.output, alone.messages);
    let patched = std::fs::read_to_string(at.join("found/arm.urdf")).unwrap();
    assert_eq!(patched.matches("<dynamics ").count(), JOINTS, "{patched}");
}

#[test]
fn what_is_wrong_with_an_arm_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write(at, "arm.urdf", SIX_AXES);
    write(at, "run.csv", &recorded(&tones(2.0, 1), 1));
    write(at, "arm.toml", "[joints.knee.drive]\ngear_ratio = 100");
    write(at, "text.urdf", "no robot");
    for (words, status, told) in [
        (&["run.csv", "--urdf", "absent.urdf"][..], 5, "absent.urdf"),
        (&["run.csv", "--urdf", "text.urdf"], 3, "FRK-D021"),
        (&["run.csv", "--urdf", "arm.urdf", "--joint", "arm.toml"], 3, "arm.toml"),
        (&["arm.urdf", "--urdf", "arm.urdf"], 3, "FRK-D"),
    ] {
        let done = run(at, &[&["arm"], words, &["-o", "out", "--quiet"]].concat());
        assert_eq!(done.status, status, "{words:?}: {}", done.messages);
        assert!(done.messages.contains(told), "{words:?}: {}", done.messages);
        assert!(!at.join("out").exists(), "{words:?}");
    }
}

/// The least distance that points of upper arm and forearm come from the boxes along a motion, m; negative within a box.
fn least_distance(motion: &str) -> f64 {
    let chain = Chain::parse(SIX_AXES, &[]).unwrap();
    let mut rows = csv::Reader::from_reader(motion.as_bytes());
    let columns: Vec<usize> = (0..JOINTS).map(|joint| 1 + 3 * joint).collect();
    // Points of the shell of both, every centimetre along them.
    let around = |radius: f64, turn: f64| [radius * turn.cos(), radius * turn.sin()];
    let mut shells: [Vec<Point3<f64>>; 2] = [Vec::new(), Vec::new()];
    for step in 0..=60 {
        let z = 0.01 * f64::from(step);
        for turn in 0..24 {
            let [x, y] = around(0.06, std::f64::consts::TAU * f64::from(turn) / 24.0);
            shells[0].push(Point3::new(x, y, z));
        }
        for edge in [-0.05, -0.025, 0.0, 0.025, 0.05] {
            for side in [-0.05, 0.05] {
                shells[1].extend([Point3::new(edge, side, z - 0.02), Point3::new(side, edge, z - 0.02)]);
            }
        }
    }
    let mut least = f64::INFINITY;
    for row in rows.records() {
        let row = row.unwrap();
        let mut pose = Isometry3::identity();
        for (joint, column) in columns.iter().enumerate().take(3) {
            let angle: f64 = row[*column].parse().unwrap();
            pose *= chain.joints[joint].pose * UnitQuaternion::new(chain.joints[joint].axis * angle);
            let Some(shell) = joint.checked_sub(1).map(|link| &shells[link]) else { continue };
            for (_, centre, size, yaw) in BOXES {
                let place = Isometry3::new(Vector3::from(centre), Vector3::z() * yaw);
                let into = place.inverse() * pose;
                for point in shell {
                    let beyond = (into * point).coords.abs() - 0.5 * Vector3::from(size);
                    let outside = beyond.sup(&Vector3::zeros()).norm();
                    least = least.min(if outside > 0.0 { outside } else { beyond.max() });
                }
            }
        }
    }
    least
}

#[test]
fn a_planned_motion_keeps_clear_of_boxes_that_it_would_hit() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write(at, "arm.urdf", &solid_robot());
    write(at, "free.toml", LIMITS);
    write(at, "boxes.toml", &format!("clearance_m = 0.03\n{LIMITS}{}", obstacles()));
    let advise = |surroundings: &str, threads: &str| {
        let words = ["arm", "--urdf", "arm.urdf", "--joint", surroundings, "--threads", threads];
        let done = run(at, &[&words[..], &["--advise", "motion.csv"]].concat());
        assert_eq!(done.status, 0, "{}", done.messages);
        (std::fs::read_to_string(at.join("motion.csv")).unwrap(), done.output)
    };
    let (free, text) = advise("free.toml", "2");
    assert!(least_distance(&free) < 0.0, "the motion without boxes would miss them");
    assert!(text.contains("Not looked at: surroundings"), "{text}");
    let (clear, text) = advise("boxes.toml", "2");
    let least = least_distance(&clear);
    assert!(least >= 0.03, "{least} m: {text}");
    for told in ["tells all 40 base parameters", "condition number", "It keeps 0.03 m clear: link `", "to obstacle `"] {
        assert!(text.contains(told), "{text}");
    }
    // One turns at a constant distance of 2.5 cm from the other.
    let not_looked_at: Vec<&str> = text.split(". ").filter(|sentence| sentence.contains("ot looked at")).collect();
    assert_eq!(not_looked_at, ["Not looked at: links that no posture keeps so far apart: `fore` and `hand`"], "{text}");
    assert_eq!(advise("boxes.toml", "1"), (clear, text), "one thread, two threads");
}

#[test]
fn what_a_planned_motion_cannot_keep_clear_of_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write(at, "arm.urdf", &solid_robot());
    write(at, "bare.urdf", SIX_AXES);
    write(at, "boxes.toml", &format!("{LIMITS}{}", obstacles()));
    let buried = obstacles().replace("[0.0, 0.0, -0.05]", "[0.0, 0.0, 0.2]");
    write(at, "buried.toml", &format!("{LIMITS}{buried}"));
    write(at, "flat.toml", &format!("{LIMITS}{}", obstacles().replace("0.06]", "0.0]")));
    for (robot, surroundings, told) in [
        ("arm.urdf", "buried.toml", &["FRK-D047", "link `turret` and obstacle `table`"][..]),
        ("arm.urdf", "flat.toml", &["FRK-D015", "flat.toml", "obstacles.size_m"]),
        ("bare.urdf", "boxes.toml", &["FRK-D014", "link_radius_m"]),
    ] {
        let done = run(at, &["arm", "--urdf", robot, "--joint", surroundings, "--advise", "motion.csv"]);
        assert_eq!((done.status, done.output.as_str()), (3, ""), "{surroundings}: {}", done.messages);
        assert!(told.iter().all(|told| done.messages.contains(told)), "{surroundings}: {}", done.messages);
        assert!(!at.join("motion.csv").exists());
    }
    // A robot without shapes: what stands in for them, and what was not looked at, is told.
    write(at, "free.toml", LIMITS);
    write(at, "wide.toml", &format!("{LIMITS}[joints.lift]\nlink_radius_m = 0.06\n"));
    for (surroundings, told) in [
        ("free.toml", "Not looked at: links of unknown shape"),
        ("wide.toml", "stand in for links whose shape is not known: `upper`."),
    ] {
        let done = run(at, &["arm", "--urdf", "bare.urdf", "--joint", surroundings, "--advise", "-"]);
        assert!(done.status == 0 && done.output.starts_with("time_s,pan_position_rad"), "{}", done.messages);
        assert!(done.messages.contains(told) && done.messages.contains("no [[obstacles]]"), "{}", done.messages);
    }
}

/// Two links that swing each other, each recorded with the other's position. With `FRIKAN_EXHAUSTIVE=1` only: two minutes. Each by itself, `fit` leaves 37 and 36 % of their torques.
#[test]
fn a_real_double_pendulum_is_one_arm() {
    if !frikan_tests::exhaustive() {
        return;
    }
    let Some(recordings) = frikan_tests::recordings() else { return };
    let source = recordings.join("../field/recordings");
    let columns = |joint: u8| {
        let text = std::fs::read_to_string(source.join(format!("dfki_dp_traj00_joint{joint}.csv"))).unwrap();
        text.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect::<Vec<Vec<String>>>()
    };
    let mut table = String::from("time_s,q1,q2,dq1,dq2,tau1,tau2\n");
    for (first, second) in columns(1).iter().zip(&columns(2)).skip(1) {
        let cells = [&first[0], &first[1], &second[1], &first[2], &second[2], &first[3], &second[3]];
        table += &cells.map(String::as_str).join(",");
        table.push('\n');
    }
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write(at, "run.csv", &table);
    // The owners' lengths and masses; nothing of the inertias.
    let links = [("upper", 0.608, -0.275), ("lower", 0.63, -0.166)].map(|(link, mass, centre)| {
        format!(r#"<link name="{link}"><inertial><origin xyz="0 0 {centre}"/><mass value="{mass}"/></inertial></link>"#)
    });
    let joint = |name: &str, parent: &str, child: &str, z: f64| {
        format!(
            r#"<joint name="{name}" type="continuous"><origin xyz="0 0 {z}"/><parent link="{parent}"/><child link="{child}"/><axis xyz="0 1 0"/></joint>"#
        )
    };
    let joints = joint("shoulder", "base", "upper", 0.0) + &joint("elbow", "upper", "lower", -0.3);
    write(at, "arm.urdf", &format!(r#"<robot name="r"><link name="base"/>{}{joints}</robot>"#, links.concat()));
    let done = run(at, &["arm", "run.csv", "--urdf", "arm.urdf", "-o", "found", "--quiet"]);
    assert!(matches!(done.status, 0 | 4), "{}", done.messages);
    let arm: Value = serde_json::from_slice(&std::fs::read(at.join("found/arm.json")).unwrap()).unwrap();
    println!("{arm:#}");
    for (joint, most) in [0.33, 0.345].into_iter().enumerate() {
        let error = number(&arm["joints"][joint]["train"]["relative_error"]);
        assert!(error < most, "{error}");
    }
}
