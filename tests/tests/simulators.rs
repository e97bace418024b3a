//! The simulator gets its model back: MuJoCo logs a joint and a simulation of it, the diagnosis finds what is missing, the export patches
//! the simulator's own file, and MuJoCo runs it on a motion that nobody has seen. `tests/setup.sh` installs it under `target/simulators`;
//! without it these tests say so and do nothing.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use frikan_tests::command::{Run, run};
use serde_json::Value;

/// The Python that has the simulators; `None` where it could not be installed.
fn python() -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../target/simulators/bin/python");
    if path.exists() {
        return Some(path);
    }
    eprintln!(
        "skipped: no simulators under target/simulators (tests/setup.sh installs them from PyPI where there is a network)"
    );
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

/// Logs a pair, diagnoses it and patches its model as `patched.xml` and, with attributes of the joint only, `attributes.xml`; gives the
/// errors on a fresh motion.
fn put_right(python: &Path, (pair, joint): (&str, &str), folder: &Path) -> Value {
    let at = folder.to_str().expect("a temporary folder has a plain name");
    script(python, &["mujoco_pair.py", "log", pair, at]);
    let found =
        trainer(folder, "diagnose real.csv --simulation simulated.csv --joint joint.toml --quiet -o better.frk");
    assert_eq!(found.status, 1, "{}", found.messages);
    for (form, file) in [("mujoco", "patched.xml"), ("mjcf-patch", "attributes.xml")] {
        let line = format!("export better.frk --to {form} --into model.xml --joint-name {joint} -o {file}");
        let exported = trainer(folder, &line);
        assert_eq!(exported.status, 0, "{}", exported.messages);
    }
    let errors = script(python, &["mujoco_pair.py", "compare", pair, at, "model.xml", "patched.xml", "attributes.xml"]);
    println!("{pair}: {errors}");
    println!("{}", std::fs::read_to_string(folder.join("patched.xml")).unwrap());
    serde_json::from_str(&errors).unwrap()
}

fn error(errors: &Value, model: &str, what: &str) -> f64 {
    errors[model][what].as_f64().unwrap_or_else(|| panic!("{model} {what}: {errors}"))
}

/// A rotor of 0.2 kg m2, twice the Coulomb friction, more viscous friction, and a Stribeck peak that MuJoCo's joints do not know.
#[test]
fn an_elbow_without_rotor_and_stribeck_friction_is_put_right() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let errors = put_right(&python, ("elbow", "elbow"), folder.path());
    let [before, truth] = ["model.xml", "true_parameters"].map(|model| error(&errors, model, "torque"));
    let [patched, attributes] = ["patched.xml", "attributes.xml"].map(|model| error(&errors, model, "torque"));
    assert!(patched < 1.1 * truth, "the true parameters leave {truth} N m, the export {patched}");
    assert!(attributes < 0.1 * before, "{before} N m before, {attributes} after");
    let position = ["model.xml", "patched.xml"].map(|model| error(&errors, model, "position"));
    assert!(position[1] < 0.1 * position[0], "{position:?} rad");
    assert_eq!(errors["patched.xml"]["controls"], 1, "the passive motor takes no control");
}

/// A linear axis that carries more than its model says, with ripple of the screw.
#[test]
fn a_linear_axis_with_ripple_is_put_right() {
    let Some(python) = python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let errors = put_right(&python, ("axis", "slide"), folder.path());
    let [before, truth] = ["model.xml", "true_parameters"].map(|model| error(&errors, model, "torque"));
    let patched = error(&errors, "patched.xml", "torque");
    assert!(patched < 1.1 * truth && patched < 0.2 * before, "{before} N before, {patched} after, truth {truth}");
}
