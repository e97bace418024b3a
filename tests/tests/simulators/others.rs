//! Drake, OpenUSD and FMPy read what was exported for them.

use frikan_runtime::friction::{FrictionState, Measurement};
use frikan_shared::effect::{Effect, MAX_EFFECTS};
use frikan_tests::models;

use crate::programs::{diagnosed, export, json, numbers, python, script};

/// Drake reads damping from URDF and SDF but no dry friction; the exported system has that, and Drake runs it on a fresh motion.
#[test]
fn drake_loads_the_elbow_and_runs_its_friction() {
    let (Some(python), Some(_)) = (python("pydrake"), python("mujoco")) else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path().to_str().unwrap();
    script(&python, &["mujoco_pair.py", "log", "elbow", at]);
    diagnosed(folder.path());
    script(&python, &["drake_pair.py", "write", at]);
    for form in ["urdf", "sdf"] {
        let line = format!("better.frk --to {form} --into elbow.{form} --joint-name elbow -o patched.{form}");
        export(folder.path(), &line);
    }
    export(folder.path(), "better.frk --to drake -o friction.py");
    let drake = json(&script(&python, &["drake_pair.py", "run", at]));
    println!("{drake}");
    let damping = numbers(&std::fs::read_to_string(folder.path().join("patched.urdf")).unwrap(), "damping")[0];
    for form in ["urdf", "sdf"] {
        let [read, position] = ["damping", "position"].map(|what| drake[form][what].as_f64().unwrap());
        assert!((read - damping).abs() < 1e-6 * damping, "{read} in Drake, {damping} in the file");
        // Let go at 1 rad, it has swung down within a second.
        assert!(position.abs() < 0.5, "{position} rad");
    }
    let [torque, position] = ["torque", "position"].map(|what| drake["python"][what].as_f64().unwrap());
    assert!(torque < 0.14 && position < 5e-4, "{torque} N m, {position} rad; true attributes leave 0.13 N m in MuJoCo");
}

/// OpenUSD composes the layer over the user's stage: the joint is there, with the schema of PhysX and its attributes.
#[test]
fn openusd_composes_the_layer_over_a_stage() {
    let Some(python) = python("pxr") else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    // 22 N m, and 8 more at rest that decay over 0.1 rad/s.
    std::fs::write(path("law.frk"), models::image(&models::stribeck_expression())).unwrap();
    script(&python, &["usd_joint.py", "write", &path("robot.usda")]);
    export(
        folder.path(),
        "law.frk --to usd --into robot.usda --joint-name /robot/elbow --inertia-of-model 0.3 -o law.usda",
    );
    let joint = json(&script(&python, &["usd_joint.py", "read", &path("law.usda"), "/robot/elbow"]));
    assert_eq!(joint["joint"], true, "{joint}");
    assert_eq!(joint["schemas"], serde_json::json!(["PhysxJointAxisAPI:angular"]));
    let value = |name: &str| joint[name].as_f64().unwrap_or_else(|| panic!("{name}: {joint}"));
    let [at_rest, moving] = ["staticFrictionEffort", "dynamicFrictionEffort"].map(value);
    assert!(moving > 20.0 && at_rest >= moving && at_rest < 31.0, "{joint}");
    assert!(value("viscousFrictionCoefficient") >= 0.0, "{joint}");
}

/// FMPy validates the unit and steps it: the friction is that of the drive to the bit, effects with their memory included.
#[test]
fn fmpy_steps_a_co_simulation_unit_as_the_drive_does() {
    let Some(python) = python("fmpy") else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let effects: Vec<Effect> = models::every_effect().into_iter().map(|(_, effect)| effect).take(MAX_EFFECTS).collect();
    for (name, model) in [("static", models::stribeck_expression()), ("stateful", models::with_effects(&effects))] {
        std::fs::write(path("law.frk"), models::image(&model)).unwrap();
        export(folder.path(), "law.frk --to fmu -o law.fmu");
        let again = std::fs::read(path("law.fmu")).unwrap();
        export(folder.path(), "law.frk --to fmu -o law.fmu");
        assert!(again == std::fs::read(path("law.fmu")).unwrap(), "one image, one unit");
        let names: Vec<&str> = model.inputs.iter().map(|input| input.quantity.name()).collect();
        let samples: Vec<Measurement> = (0..600).map(|step| moving(step as f32 * 1e-3)).collect();
        let mut text = names.join(",") + "\n";
        for sample in &samples {
            let values = names.iter().map(|name| channel(sample, name).to_string());
            text += &(values.collect::<Vec<_>>().join(",") + "\n");
        }
        std::fs::write(path("inputs.csv"), text).unwrap();
        let unit = json(&script(&python, &["fmu_unit.py", &path("law.fmu"), &path("inputs.csv")]));
        assert_eq!(unit["problems"], serde_json::json!([]), "{name}");
        assert_eq!((&unit["repeats"], &unit["starts_anew"]), (&true.into(), &true.into()), "{name}");
        assert_eq!(unit["inputs"]["velocity"], "rad/s");
        let mut state = FrictionState::new();
        for (step, sample) in samples.iter().enumerate() {
            let expected = state.step(&model, sample, 1.0e-3);
            let outputs = &unit["outputs"][step];
            assert_eq!(outputs[0].as_f64(), Some(f64::from(expected.torque)), "{name}, step {step}");
            if let Some(position) = outputs[1].as_f64() {
                assert_eq!(position, f64::from(expected.position), "{name}, step {step}");
            }
        }
        if name == "static" {
            assert_eq!(unit["simulated"], unit["outputs"][0][0]);
        }
    }
}

/// A motion with reversals and stops, and channels that change.
fn moving(time: f32) -> Measurement {
    let velocity = if (0.2..0.25).contains(&time) { 0.0 } else { 0.8 * (17.0 * time).sin() };
    let (position, load) = (0.3 * (9.0 * time).sin(), 1.5 * (5.0 * time).cos());
    Measurement { velocity, position, load, temperature: 20.0 + 10.0 * time, ..Measurement::ZERO }
}

fn channel(sample: &Measurement, name: &str) -> f32 {
    match name {
        "velocity" => sample.velocity,
        "position" => sample.position,
        "load" => sample.load,
        "temperature" => sample.temperature,
        other => panic!("no channel {other}"),
    }
}
