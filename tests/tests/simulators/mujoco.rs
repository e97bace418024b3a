//! Five joints of MuJoCo and their simulations: what the diagnosis names, and how near the patched model comes to the real joint, beside the
//! simulation with the truth and the one that MuJoCo's own `sysid` fits to the same recording.

use std::path::Path;

use frikan_tests::exhaustive;
use serde_json::Value;

use crate::programs::{diagnosed, export, json, numbers, python, script};

/// What a pair gives.
struct PutRight {
    /// Names of the findings in alphabetical order.
    findings: Vec<String>,
    /// What the diagnosis says in words.
    told: String,
    /// Errors on a fresh motion: of the simulation as it was, of its joint with true attributes, of all of the truth that MuJoCo can have,
    /// of what `sysid` fits, and of both exports.
    errors: Value,
    /// The patched files.
    patched: String,
    attributes: String,
}

impl PutRight {
    fn error(&self, model: &str, what: &str) -> f64 {
        self.errors[model][what].as_f64().unwrap_or_else(|| panic!("{model} {what}: {}", self.errors))
    }

    fn torque(&self, model: &str) -> f64 {
        self.error(model, "torque")
    }

    /// The torque error of a model is at most a tenth above that of another.
    fn is_as_near_as(&self, model: &str, other: &str) {
        let [error, reference] = [model, other].map(|name| self.torque(name));
        assert!(
            error < 1.1 * reference,
            "{model} leaves {error}, {other} {reference}, the simulation {}",
            self.torque("model.xml")
        );
    }

    /// Both exports come as near as the truth in their form, the one with a passive motor nearer than what `sysid` fits.
    fn is_as_near_as_the_truth(&self) {
        self.is_as_near_as("patched.xml", "true_model");
        self.is_as_near_as("attributes.xml", "true_attributes");
        let [patched, fitted] = ["patched.xml", "sysid"].map(|model| self.torque(model));
        assert!(patched < fitted, "the export leaves {patched}, sysid {fitted}");
    }
}

/// Logs a pair, diagnoses it and patches its model as `patched.xml` and, with attributes of the joint only, `attributes.xml`. `None` without
/// MuJoCo and all that its `sysid` needs.
fn put_right(pair: &str, joint: &str) -> Option<PutRight> {
    let python = python("mujoco.sysid.report.defaults")?;
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let at = folder.to_str().expect("a temporary folder has a plain name");
    script(&python, &["mujoco_pair.py", "log", pair, at]);
    let found = diagnosed(folder);
    let diagnosis: Value = serde_json::from_slice(&std::fs::read(folder.join("found.json")).unwrap()).unwrap();
    let findings = diagnosis["findings"].as_array().unwrap().iter();
    let mut findings: Vec<String> = findings.map(|found| found["effect"].as_str().unwrap().to_owned()).collect();
    findings.sort_unstable();
    for (form, file) in [("mujoco", "patched.xml"), ("mjcf-patch", "attributes.xml")] {
        export(folder, &format!("better.frk --to {form} --into model.xml --joint-name {joint} -o {file}"));
    }
    let errors =
        script(&python, &["mujoco_pair.py", "compare", pair, at, "model.xml", "patched.xml", "attributes.xml"]);
    let [patched, attributes] =
        ["patched.xml", "attributes.xml"].map(|file| std::fs::read_to_string(folder.join(file)).unwrap());
    println!("{pair}: {errors}\n{patched}\n{}", found.output);
    holds_in_other_settings(&python, folder, (pair, joint));
    Some(PutRight { findings, told: found.output, errors: json(&errors), patched, attributes })
}

/// In files of other time steps, integrators and controllers the export is never worse than true attributes nor than `mjcf-patch`, and
/// leaves what it says: one setting of the elbow, or all ten of `mujoco_settings.py` of all joints.
fn holds_in_other_settings(python: &Path, folder: &Path, (pair, joint): (&str, &str)) {
    let count = match (exhaustive(), pair) {
        (true, _) => "10",
        (false, "elbow") => "1",
        (false, _) => return,
    };
    let at = folder.to_str().expect("a temporary folder has a plain name");
    let count_of = script(python, &["mujoco_settings.py", "write", pair, at, count]);
    export(folder, "better.frk --to python -o image.py");
    for index in 0..count_of.trim().parse().unwrap() {
        for (form, file) in [("mujoco", "patched"), ("mjcf-patch", "attributes")] {
            let into = format!("--into setting-{index}.xml --joint-name {joint}");
            export(folder, &format!("better.frk --to {form} {into} -o {file}-{index}.xml"));
        }
    }
    let compared = json(&script(python, &["mujoco_settings.py", "compare", pair, at, count]));
    for found in compared.as_array().unwrap() {
        println!("{pair} {found}");
        let [patched, plain, truth] =
            ["patched", "attributes", "true_attributes"].map(|name| found[name].as_f64().unwrap());
        assert!(patched < 1.05 * truth && patched < 1.001 * plain, "{pair}: {found}");
        for stated in found["stated"].as_array().unwrap() {
            let [stated, shown] = [0, 1].map(|place| stated[place].as_f64().unwrap());
            near(stated, shown, 0.2, &format!("{pair}: {found}"));
        }
    }
}

fn near(found: f64, truth: f64, share: f64, what: &str) {
    assert!((found / truth - 1.0).abs() < share, "{what}: {found}, and {truth} is true");
}

/// The steps with which the exporter's own are compared are those of the MuJoCo that is installed.
#[test]
fn the_kept_steps_of_a_joint_are_those_of_mujoco() {
    let Some(python) = python("mujoco") else { return };
    let kept = include_str!("../../../trainer/src/export/simulator/trial/mujoco_steps.txt");
    let printed = script(&python, &["joint_steps.py"]);
    assert_eq!(kept.lines().count(), printed.lines().count());
    for (kept, printed) in kept.lines().zip(printed.lines()) {
        let near = |(kept, printed): (&str, &str)| match [kept, printed].map(|word| word.parse::<f64>().ok()) {
            [Some(kept), Some(printed)] => (kept - printed).abs() <= 1e-7 * kept.abs().max(1e-4),
            _ => kept == printed,
        };
        assert!(kept.split(' ').zip(printed.split(' ')).all(near), "{kept}\n{printed}");
    }
}

/// A rotor of 0.2 kg m2, twice the Coulomb friction, more viscous friction, and a Stribeck peak that the simulation lacks.
#[test]
fn an_elbow_without_rotor_and_stribeck_friction_is_put_right() {
    let Some(elbow) = put_right("elbow", "elbow") else { return };
    assert_eq!(elbow.findings, ["friction_level", "inertia_error", "stribeck"]);
    assert!(!elbow.told.contains("in the simulation itself"), "{}", elbow.told);
    let [coulomb, at_rest, velocity] = numbers(&elbow.patched, "lugre")[2..] else { panic!("{}", elbow.patched) };
    // The peak alone stands in bristles, beside `frictionloss`: what leaves the least in simulation.
    let beside = numbers(&elbow.patched, "frictionloss")[0];
    near(beside + coulomb, 2.0, 0.05, "Coulomb friction, N m");
    near(beside + at_rest, 3.0, 0.15, "static friction, N m");
    near(velocity, 0.1, 0.15, "Stribeck velocity, rad/s");
    near(numbers(&elbow.patched, "damping")[0], 1.2, 0.03, "damping, N m s/rad");
    near(numbers(&elbow.patched, "armature")[0], 0.2, 0.03, "armature, kg m2");
    elbow.is_as_near_as_the_truth();
    let position = ["model.xml", "patched.xml"].map(|model| elbow.error(model, "position"));
    assert!(position[1] < 0.1 * position[0], "{position:?} rad");
    assert_eq!(elbow.errors["patched.xml"]["controls"], 1, "the passive motor takes no control");
}

/// A linear axis that carries more than its model says, with ripple of the screw and no Stribeck peak.
#[test]
fn a_linear_axis_with_ripple_is_put_right() {
    let Some(axis) = put_right("axis", "slide") else { return };
    assert_eq!(axis.findings, ["friction_level", "inertia_error", "position_ripple"]);
    assert!(!axis.told.contains("in the simulation itself"), "{}", axis.told);
    assert!(!axis.patched.contains("lugre"), "{}", axis.patched);
    for file in [&axis.patched, &axis.attributes] {
        near(numbers(file, "frictionloss")[0], 35.0, 0.03, "friction at rest and in motion, N");
        near(numbers(file, "damping")[0], 90.0, 0.03, "damping, N s/m");
        near(numbers(file, "armature")[0], 5.0, 0.03, "armature, kg");
    }
    axis.is_as_near_as_the_truth();
}

/// A servo under a `position` actuator with a rotor and presliding that the simulation lacks, its friction level and damping too low.
#[test]
fn a_servo_with_presliding_under_a_position_actuator_is_put_right() {
    let Some(servo) = put_right("servo", "servo") else { return };
    assert_eq!(servo.findings, ["friction_level", "inertia_error", "presliding"]);
    assert!(!servo.told.contains("in the simulation itself"), "{}", servo.told);
    let [stiffness, _, coulomb, at_rest, _] = numbers(&servo.patched, "lugre")[..] else { panic!("{}", servo.patched) };
    near(stiffness, 250.0, 0.2, "stiffness of the presliding, N m/rad");
    near(coulomb, 1.0, 0.03, "Coulomb friction, N m");
    near(at_rest, 1.0, 0.03, "static friction, N m");
    for file in [&servo.patched, &servo.attributes] {
        near(numbers(file, "damping")[0], 0.35, 0.1, "damping, N m s/rad");
        near(numbers(file, "armature")[0], 0.03, 0.05, "armature, kg m2");
    }
    servo.is_as_near_as_the_truth();
}

/// A gear that loses a tenth of what it transmits, which a torque sensor behind it records; the simulation has too little constant friction
/// and none of the load. MuJoCo's friction knows no load: the export adds the mean of the load friction to the constant, which is as good as the best
/// constant and as what `sysid` fits.
#[test]
fn a_gear_with_load_friction_gets_the_mean_of_it() {
    let Some(gear) = put_right("gear", "shoulder") else { return };
    assert_eq!(gear.findings, ["load_friction"]);
    assert!(!gear.told.contains("in the simulation itself"), "{}", gear.told);
    assert!(!gear.patched.contains("lugre"), "{}", gear.patched);
    for file in [&gear.patched, &gear.attributes] {
        assert!(file.contains("Load-dependent friction stands at its mean"), "{file}");
        near(numbers(file, "damping")[0], 1.0, 0.03, "damping, N m s/rad");
        near(numbers(file, "armature")[0], 0.3, 0.03, "armature, kg m2");
    }
    for file in ["patched.xml", "attributes.xml"] {
        gear.is_as_near_as(file, "true_model");
        gear.is_as_near_as(file, "sysid");
    }
}

/// The elbow of an arm of which the shoulder moves too, with a rotor and a Stribeck peak that the simulation lacks, its friction level and
/// damping too low. Torques that come from the shoulder are in the simulation as in the real arm, and none of them is named.
#[test]
fn an_elbow_behind_a_moving_shoulder_is_put_right() {
    let Some(arm) = put_right("arm", "elbow") else { return };
    assert_eq!(arm.findings, ["friction_level", "inertia_error", "stribeck"]);
    for file in [&arm.patched, &arm.attributes] {
        let (_, elbow) = file.split_once("<joint name=\"elbow\"").expect("the arm has an elbow");
        near(numbers(elbow, "armature")[0], 0.12, 0.03, "armature, kg m2");
    }
    arm.is_as_near_as("attributes.xml", "true_attributes");
    let [before, patched] = ["model.xml", "patched.xml"].map(|model| arm.torque(model));
    assert!(patched < 0.1 * before, "{patched} N m of {before}");
    assert_eq!(arm.errors["patched.xml"]["controls"], 2, "the passive motor takes no control");
}
