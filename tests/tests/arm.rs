//! `trainer arm`: a simulated arm of six axes whose bodies, rotors and friction are known, as its user sees it.

use std::path::Path;

use frikan_tests::arm::{
    COULOMB, JOINTS, LOAD, NOISE, SIX_AXES, VISCOUS, evaluate, numbers, point_to_point, recorded, tones,
};
use frikan_tests::command::run;
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
