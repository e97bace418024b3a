//! What is written for MuJoCo 3, MJX or Newton runs there, with the attributes that the file has in force.

use crate::programs::{export, json, numbers, python_of, script};
use frikan_tests::fixtures;

#[test]
fn mujoco_3_mjx_and_newton_run_what_is_written_for_them() {
    let Some(python) = python_of("mujoco3", "newton, mujoco.mjx") else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let path = |file: &str| at.join(file).to_str().expect("a temporary folder has a plain name").to_owned();
    script(&python, &["mujoco_family.py", "model", &path("model.xml")]);
    let image = fixtures::folder().join("elbow.frk");
    let image = image.to_str().expect("the workspace has a plain name");
    let simulators = ["mujoco3", "mjx", "newton"];
    for simulator in simulators {
        let words =
            format!("--to mujoco --simulator {simulator} --into model.xml --joint-name elbow -o {simulator}.xml");
        export(at, &format!("{image} {words}"));
    }
    let files = simulators.map(|simulator| path(&format!("{simulator}.xml")));
    // Newton says before what it compiles.
    let printed = script(&python, &["mujoco_family.py", "run", &files[0], &files[1], &files[2]]);
    let told = json(printed.lines().last().expect("it ends with its results"));
    println!("{told}");
    for (simulator, file) in simulators.into_iter().zip(&files) {
        let text = std::fs::read_to_string(file).unwrap();
        let found = &told[simulator];
        for attribute in ["armature", "damping", "frictionloss"] {
            let [written] = numbers(&text, attribute)[..] else { panic!("{simulator} {attribute}: {text}") };
            let in_force = found[attribute].as_f64().unwrap();
            // Newton keeps single precision.
            assert!((in_force / written - 1.0).abs() < 1e-6, "{simulator} {attribute}: {in_force}, written {written}");
        }
        // The joint moves, and as MuJoCo 3 moves it: to the bits of a double in JAX, of a float in Newton.
        let within = match simulator {
            "mujoco3" => continue,
            "mjx" => 1e-9,
            _ => 1e-4,
        };
        let differs = found["differs"].as_f64().unwrap();
        assert!(differs < within, "{simulator}: {differs} rad");
    }
    assert!(told["mujoco3"]["travel"].as_f64().unwrap() > 0.3, "{told}");
}
