//! The simulator gets its model back: MuJoCo logs a joint and a simulation of it, the diagnosis finds what is missing, the export patches
//! the simulator's own file, and MuJoCo or Drake runs it on a motion that nobody has seen. Other formats are read by their own programs.
//! `tests/setup.sh` installs these under `target/simulators`; without one its tests say so and do nothing.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use frikan_runtime::friction::{FrictionState, Measurement};
use frikan_shared::effect::{Effect, MAX_EFFECTS};
use frikan_tests::command::{Run, run};
use frikan_tests::models;
use serde_json::Value;

/// The Python that has a module; `None` where it could not be installed.
fn python(module: &str) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/simulators/bin/python");
    let import = format!("import {module}");
    if path.exists() && Command::new(&path).args(["-c", &import]).output().is_ok_and(|run| run.status.success()) {
        return Some(path);
    }
    eprintln!("skipped: no {module} under target/simulators (tests/setup.sh installs it where there is a network)");
    None
}

/// What a script of `tests/simulators` prints.
fn script(python: &Path, words: &[&str]) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("simulators");
    let Output { status, stdout, stderr } =
        Command::new(python).arg("-B").current_dir(folder).args(words).output().expect("Python starts");
    assert!(status.success(), "{words:?}\n{}", String::from_utf8_lossy(&stderr));
    String::from_utf8_lossy(&stdout).into_owned()
}

fn trainer(folder: &Path, line: &str) -> Run {
    run(folder, &line.split_whitespace().collect::<Vec<_>>())
}

/// What a pair gives.
struct PutRight {
    /// Names of the findings in alphabetical order.
    findings: Vec<String>,
    /// What the diagnosis says in words.
    told: String,
    /// Errors on a fresh motion: of the simulation as it was, of its joint with true attributes, of all of the truth that MuJoCo can have,
    /// and of both exports.
    errors: Value,
    /// The patched files.
    patched: String,
    attributes: String,
}

impl PutRight {
    fn error(&self, model: &str, what: &str) -> f64 {
        self.errors[model][what].as_f64().unwrap_or_else(|| panic!("{model} {what}: {}", self.errors))
    }

    fn torque<const N: usize>(&self, models: [&str; N]) -> [f64; N] {
        models.map(|model| self.error(model, "torque"))
    }
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

fn export(folder: &Path, line: &str) {
    let exported = trainer(folder, &format!("export {line}"));
    assert_eq!(exported.status, 0, "{}", exported.messages);
}

/// Writes `better.frk` and `found.json` from the logs of a pair.
fn diagnosed(folder: &Path) -> Run {
    let files = "--quiet --json found.json -o better.frk";
    let found = trainer(folder, &format!("diagnose real.csv --simulation simulated.csv --joint joint.toml {files}"));
    assert_eq!(found.status, 1, "{}", found.messages);
    found
}

/// Logs a pair, diagnoses it and patches its model as `patched.xml` and, with attributes of the joint only, `attributes.xml`.
fn put_right(python: &Path, (pair, joint): (&str, &str), folder: &Path) -> PutRight {
    let at = folder.to_str().expect("a temporary folder has a plain name");
    script(python, &["mujoco_pair.py", "log", pair, at]);
    let found = diagnosed(folder);
    let diagnosis: Value = serde_json::from_slice(&std::fs::read(folder.join("found.json")).unwrap()).unwrap();
    let findings = diagnosis["findings"].as_array().unwrap().iter();
    let mut findings: Vec<String> = findings.map(|found| found["effect"].as_str().unwrap().to_owned()).collect();
    findings.sort_unstable();
    for (form, file) in [("mujoco", "patched.xml"), ("mjcf-patch", "attributes.xml")] {
        export(folder, &format!("better.frk --to {form} --into model.xml --joint-name {joint} -o {file}"));
    }
    let errors = script(python, &["mujoco_pair.py", "compare", pair, at, "model.xml", "patched.xml", "attributes.xml"]);
    let [patched, attributes] =
        ["patched.xml", "attributes.xml"].map(|file| std::fs::read_to_string(folder.join(file)).unwrap());
    println!("{pair}: {errors}\n{patched}\n{}", found.output);
    PutRight { findings, told: found.output, errors: json(&errors), patched, attributes }
}

/// The numbers of the first attribute of that name in an XML file.
fn numbers(xml: &str, name: &str) -> Vec<f64> {
    let (_, rest) = xml.split_once(&format!(" {name}=\"")).unwrap_or_else(|| panic!("no {name}: {xml}"));
    let (value, _) = rest.split_once('"').expect("an attribute ends");
    value.split_whitespace().map(|word| word.parse().unwrap()).collect()
}

fn near(found: f64, truth: f64, share: f64, what: &str) {
    assert!((found / truth - 1.0).abs() < share, "{what}: {found}, and {truth} is true");
}

/// A rotor of 0.2 kg m2, twice the Coulomb friction, more viscous friction, and a Stribeck peak that the simulation lacks.
#[test]
fn an_elbow_without_rotor_and_stribeck_friction_is_put_right() {
    let Some(python) = python("mujoco") else { return };
    let folder = tempfile::tempdir().unwrap();
    let elbow = put_right(&python, ("elbow", "elbow"), folder.path());
    assert_eq!(elbow.findings, ["friction_level", "inertia_error", "stribeck"]);
    assert!(!elbow.told.contains("in the simulation itself"), "{}", elbow.told);
    let [coulomb, at_rest, velocity] = numbers(&elbow.patched, "lugre")[2..] else { panic!("{}", elbow.patched) };
    near(coulomb, 2.0, 0.05, "Coulomb friction, N m");
    near(at_rest, 3.0, 0.15, "static friction, N m");
    near(velocity, 0.1, 0.15, "Stribeck velocity, rad/s");
    near(numbers(&elbow.patched, "damping")[0], 1.2, 0.03, "damping, N m s/rad");
    near(numbers(&elbow.patched, "armature")[0], 0.2, 0.03, "armature, kg m2");
    let [before, patched, attributes] = elbow.torque(["model.xml", "patched.xml", "attributes.xml"]);
    let [true_attributes, true_model] = elbow.torque(["true_attributes", "true_model"]);
    assert!(patched < 1.1 * true_model, "the truth leaves {true_model} N m, the export {patched} of {before}");
    assert!(attributes < 1.1 * true_attributes, "true attributes leave {true_attributes} N m, the export {attributes}");
    let position = ["model.xml", "patched.xml"].map(|model| elbow.error(model, "position"));
    assert!(position[1] < 0.1 * position[0], "{position:?} rad");
    assert_eq!(elbow.errors["patched.xml"]["controls"], 1, "the passive motor takes no control");
}

/// A linear axis that carries more than its model says, with ripple of the screw and no Stribeck peak.
#[test]
fn a_linear_axis_with_ripple_is_put_right() {
    let Some(python) = python("mujoco") else { return };
    let folder = tempfile::tempdir().unwrap();
    let axis = put_right(&python, ("axis", "slide"), folder.path());
    assert_eq!(axis.findings, ["friction_level", "inertia_error", "position_ripple"]);
    assert!(!axis.told.contains("in the simulation itself"), "{}", axis.told);
    assert!(!axis.patched.contains("lugre"), "{}", axis.patched);
    for file in [&axis.patched, &axis.attributes] {
        near(numbers(file, "frictionloss")[0], 35.0, 0.03, "friction at rest and in motion, N");
        near(numbers(file, "damping")[0], 90.0, 0.03, "damping, N s/m");
        near(numbers(file, "armature")[0], 5.0, 0.03, "armature, kg");
    }
    let [before, patched, attributes] = axis.torque(["model.xml", "patched.xml", "attributes.xml"]);
    let [true_attributes, true_model] = axis.torque(["true_attributes", "true_model"]);
    assert!(patched < 1.1 * true_model, "the truth leaves {true_model} N, the export {patched} of {before}");
    assert!(attributes < 1.1 * true_attributes, "true attributes leave {true_attributes} N, the export {attributes}");
}

/// A servo under a `position` actuator with a rotor and presliding that the simulation lacks, its friction level and damping too low.
#[test]
fn a_servo_with_presliding_under_a_position_actuator_is_put_right() {
    let Some(python) = python("mujoco") else { return };
    let folder = tempfile::tempdir().unwrap();
    let servo = put_right(&python, ("servo", "servo"), folder.path());
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
    let [before, patched, attributes] = servo.torque(["model.xml", "patched.xml", "attributes.xml"]);
    let [true_attributes, true_model] = servo.torque(["true_attributes", "true_model"]);
    assert!(patched < 1.1 * true_model, "the truth leaves {true_model} N m, the export {patched} of {before}");
    assert!(attributes < 1.1 * true_attributes, "true attributes leave {true_attributes} N m, the export {attributes}");
}

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
