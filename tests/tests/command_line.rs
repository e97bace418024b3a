//! The command line on good recordings: results, files, keys of the JSON, determinism.

use std::path::Path;

use frikan_tests::command::run;
use frikan_tests::fixtures::separated_recording;
use frikan_tests::paper::JOINTS;
use serde_json::Value;

fn write(folder: &Path, name: &str, text: &str) {
    std::fs::write(folder.join(name), text).unwrap();
}

/// A folder with two separated recordings of the published law.
fn bench() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path(), "train.csv", &separated_recording(JOINTS[0], 600, 1));
    write(folder.path(), "test.csv", &separated_recording(JOINTS[0], 300, 2));
    folder
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
    let mut names: Vec<String> = entries.map(|name| name.to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

#[test]
fn fit_show_predict_verify_and_export_hang_together() {
    let folder = bench();
    let at = folder.path();
    let fit = run(
        at,
        &["fit", "train.csv", "--test", "test.csv", "-o", "m.frk", "--json", "m.json", "--report", "m.html", "--quiet"],
    );
    assert_eq!((fit.status, fit.messages.as_str()), (0, ""));
    assert!(fit.output.contains("friction = ") && fit.output.contains("coulomb_torque"), "{}", fit.output);
    assert_eq!(names(at), ["m.frk", "m.html", "m.json", "test.csv", "train.csv"]);

    let json: Value = serde_json::from_slice(&std::fs::read(at.join("m.json")).unwrap()).unwrap();
    assert_eq!(json["schema"], "frikan.fit/1");
    for key in [
        "inputs",
        "representation",
        "expression",
        "expression_nodes",
        "parameters",
        "train",
        "test",
        "image",
        "seconds",
        "seed",
    ] {
        assert!(!json[key].is_null(), "{key}");
    }
    for key in ["name", "symbol", "value", "unit", "ci95"] {
        assert!(!json["parameters"][0][key].is_null(), "{key}");
    }
    for key in ["recording", "n", "r2", "rmse"] {
        assert!(!json["test"][0][key].is_null(), "{key}");
    }
    assert!(json["test"][0]["r2"].as_f64().unwrap() > 0.9999);
    let image = std::fs::read(at.join("m.frk")).unwrap();
    assert_eq!(json["image"]["bytes"].as_u64(), Some(image.len() as u64));

    let show = run(at, &["show", "m.frk"]);
    assert_eq!(show.status, 0);
    assert!(show.output.contains("velocity from -") && show.output.contains("seed 1"), "{}", show.output);

    let predict = run(at, &["predict", "m.frk", "test.csv", "-o", "p.csv"]);
    assert_eq!((predict.status, predict.messages.as_str()), (0, ""));
    let text = std::fs::read_to_string(at.join("p.csv")).unwrap();
    assert!(
        text.starts_with("velocity_rad_s,friction_torque_Nm,predicted_friction_torque_Nm,residual_Nm\n"),
        "{text:.120}"
    );
    assert_eq!(text.lines().count(), 301);

    let verify = run(at, &["verify", "m.frk", "--recording", "test.csv", "--json"]);
    let json: Value = serde_json::from_str(&verify.output).unwrap();
    assert_eq!((verify.status, &json["compared"]), (0, &json["equal"]));
    assert!(json["schema"] == "frikan.verify/1" && json["first_difference"].is_null());

    for (form, file) in
        [("bin", "m.bin"), ("c-header", "m.h"), ("json", "m.image.json"), ("mujoco", "m.xml"), ("urdf", "m.urdf")]
    {
        assert_eq!(run(at, &["export", "m.frk", "--to", form, "-o", file]).status, 0, "{form}");
    }
    assert!(std::fs::read(at.join("m.bin")).unwrap() == image);
}

#[test]
fn one_seed_one_image_on_any_number_of_threads() {
    let folder = bench();
    let image = |threads: &str, name: &str| {
        let fit = run(
            folder.path(),
            &["fit", "train.csv", "-o", name, "--threads", threads, "--representation", "table", "--quiet"],
        );
        assert_eq!(fit.status, 0, "{}", fit.messages);
        std::fs::read(folder.path().join(name)).unwrap()
    };
    assert!(image("1", "a.frk") == image("2", "b.frk"));
}

#[test]
fn json_on_standard_output_is_nothing_but_json() {
    let folder = bench();
    let fit = run(folder.path(), &["fit", "train.csv", "-o", "m.frk", "--json", "-"]);
    assert_eq!(serde_json::from_str::<Value>(&fit.output).unwrap()["schema"], "frikan.fit/1");
}

/// The published law hardly bends, so that its smoothing grows without end.
#[test]
fn a_law_that_hardly_bends_has_a_band() {
    let folder = tempfile::tempdir().unwrap();
    let recording = frikan_tests::fixtures::folder().join("stribeck-test.csv");
    let fit = run(folder.path(), &["fit", recording.to_str().unwrap(), "-o", "m.frk", "--json", "-", "--quiet"]);
    assert_eq!(fit.status, 0, "{}", fit.messages);
    let band = serde_json::from_str::<Value>(&fit.output).unwrap()["band"]["points"].take();
    assert!(band.as_array().unwrap().iter().flat_map(|point| point.as_array().unwrap()).all(Value::is_number));
}

#[test]
fn results_never_replace_an_input_or_each_other() {
    let folder = bench();
    let before = std::fs::read(folder.path().join("train.csv")).unwrap();
    for arguments in [
        ["fit", "train.csv", "-o", "train.csv", "--quiet", "--seed", "1"],
        ["fit", "train.csv", "-o", "m.frk", "--json", "m.frk", "--quiet"],
    ] {
        assert_eq!(run(folder.path(), &arguments).status, 2);
    }
    assert!(std::fs::read(folder.path().join("train.csv")).unwrap() == before);
    assert_eq!(names(folder.path()), ["test.csv", "train.csv"]);
}

#[test]
fn the_form_of_the_law_may_be_fixed() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let [recording, joint] =
        ["elbow.csv", "elbow.toml"].map(|name| format!("{}/../fixtures/{name}", env!("CARGO_MANIFEST_DIR")));
    let fit = |form: &[&str]| {
        let words = ["fit", &recording, "--joint", &joint, "-o", "m.frk", "--json", "m.json", "--quiet"];
        run(at, &[&words, form].concat())
    };
    // Friction of the elbow is Coulomb's, viscous, and falls with the speed; the form that is asked for has the first alone.
    let fixed = fit(&["--form", "coulomb"]);
    assert_eq!(fixed.status, 0, "{}", fixed.messages);
    let json: Value = serde_json::from_slice(&std::fs::read(at.join("m.json")).unwrap()).unwrap();
    let parameters = json["parameters"].as_array().unwrap().iter();
    let names: Vec<&str> = parameters.map(|parameter| parameter["name"].as_str().unwrap()).collect();
    assert!(names.contains(&"coulomb_torque"), "{names:?}");
    assert!(!names.iter().any(|name| name.contains("stribeck") || name.contains("viscous")), "{names:?}");
    assert_eq!(json["representation"], "expression");

    let misspelt = fit(&["--form", "stribek"]);
    assert_eq!(misspelt.status, 2);
    assert!(misspelt.messages.contains("stribeck"), "{}", misspelt.messages);
    let both = fit(&["--form", "stribeck", "--representation", "table"]);
    assert_eq!(both.status, 2);
    assert!(both.messages.contains("cannot be a table"), "{}", both.messages);
}

#[test]
fn the_only_joint_of_a_simulators_file_needs_no_name() {
    let folder = bench();
    let at = folder.path();
    assert_eq!(run(at, &["fit", "train.csv", "-o", "m.frk", "--quiet"]).status, 0);
    let joint = |name: &str, kind: &str| {
        format!(
            "<joint name=\"{name}\" type=\"{kind}\"><parent link=\"a\"/><child link=\"b\"/><axis xyz=\"0 0 1\"/></joint>"
        )
    };
    let robot = |joints: &str| format!("<robot name=\"r\"><link name=\"a\"/><link name=\"b\"/>{joints}</robot>");
    write(at, "one.urdf", &robot(&(joint("base", "fixed") + &joint("elbow", "continuous"))));
    write(at, "two.urdf", &robot(&(joint("wrist", "revolute") + &joint("elbow", "continuous"))));
    let export =
        |words: &str| run(at, &format!("export m.frk --to urdf {words} -o out.urdf").split(' ').collect::<Vec<_>>());
    let only = export("--into one.urdf");
    assert_eq!(only.status, 0, "{}", only.messages);
    let without = std::fs::read(at.join("out.urdf")).unwrap();
    assert_eq!(export("--into one.urdf --joint-name elbow").status, 0);
    assert!(std::fs::read(at.join("out.urdf")).unwrap() == without);
    for words in ["--into two.urdf", "--into two.urdf --joint-name real", "--into one.urdf --joint-name real"] {
        let refused = export(words);
        assert!(refused.status == 3 && refused.messages.contains("FRK-D030"), "{words}: {}", refused.messages);
        assert!(
            refused.messages.contains("elbow") && refused.messages.contains("--joint-name"),
            "{}",
            refused.messages
        );
    }
}
