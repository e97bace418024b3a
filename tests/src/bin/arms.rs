//! Fits simulated recordings of an arm of six axes by the command line, and writes `docs/arm-accuracy.md`.

use std::fmt::Write as _;
use std::path::Path;

use frikan_tests::arm::{COULOMB, LOAD, NOISE, SIX_AXES, VISCOUS, evaluate, numbers, point_to_point, recorded, tones};
use frikan_tests::command::run;
use frikan_trainer::files::write_whole;
use serde_json::Value;

/// Where the tables go, from the root of the repository.
const PAGE: &str = "docs/arm-accuracy.md";
/// Draws of the noise and of both motions.
const DRAWS: u64 = 3;

const HEAD: &str = "\
# A simulated arm of six axes

Written by `cargo run --release -p frikan-tests --bin arms`; nothing below the line is typed by hand.

Six revolute joints with rotors, Coulomb and viscous friction, of two joints growing with the transmitted load, encoders of 20 bits, 250 Hz, white
noise of the torque. `trainer arm` learns from a minute of six tones a joint, from a URDF whose masses are up to a quarter off, and is scored on a
motion from point to point. Error on the fresh motion: root mean square on rows in motion, over that of the noise.

---
";

fn main() {
    let mut page = String::from(HEAD);
    for draw in 1..=DRAWS {
        let arm = fitted(draw);
        let _ = write!(
            page,
            "\n**Draw {draw}**\n\n| joint | Coulomb, N m (true) | viscous, N m s/rad (true) | load friction (true) | fresh motion |\n|---|---|---|---|---|\n"
        );
        for (joint, found) in list(&arm["joints"]).iter().enumerate() {
            let constant = |name: &str| {
                let found = list(&found["parameters"]).iter().find(|parameter| parameter["name"] == name);
                found.map_or_else(|| "none".to_owned(), |parameter| format!("{:.3}", number(&parameter["value"])))
            };
            let load = &found["load_friction"];
            let load = if load.is_null() { "none".to_owned() } else { format!("{:.4}", number(&load["value"])) };
            let truth = if LOAD[joint] > 0.0 { LOAD[joint].to_string() } else { "none".to_owned() };
            let fresh = number(&found["test"][0]["moving"]["rmse"]) / NOISE[joint];
            let _ = writeln!(
                page,
                "| {} | {} ({}) | {} ({}) | {load} ({truth}) | {fresh:.3} |",
                found["name"].as_str().unwrap_or_default(),
                constant("coulomb_torque"),
                COULOMB[joint],
                constant("viscous_coefficient"),
                VISCOUS[joint],
            );
        }
        let numbers = numbers();
        let off = |parameter: &&Value| {
            let truth = evaluate(parameter["expression"].as_str().unwrap_or_default(), &numbers);
            (number(&parameter["value"]) / truth - 1.0).abs()
        };
        let parameters = list(&arm["base_parameters"]);
        let determined: Vec<&Value> = parameters.iter().filter(|parameter| parameter["determined"] == true).collect();
        let worst = determined.iter().map(off).fold(0.0, f64::max);
        let _ = writeln!(
            page,
            "\nOf {} base parameters {} are determined; the worst of these is {:.1} % off.",
            parameters.len(),
            determined.len(),
            100.0 * worst
        );
    }
    write_whole(Path::new(PAGE), page.as_bytes()).expect("the page is written");
}

/// What `arm.json` says of one draw.
fn fitted(draw: u64) -> Value {
    let folder = tempfile::tempdir().expect("a folder");
    let write = |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file is written");
    write(
        "arm.urdf",
        &SIX_AXES.replace("mass value=\"13\"", "mass value=\"16\"").replace("mass value=\"4\"", "mass value=\"3\""),
    );
    write("train.csv", &recorded(&tones(60.0, draw), draw));
    write("test.csv", &recorded(&point_to_point(10, 100 + draw), 100 + draw));
    let words = ["arm", "train.csv", "--urdf", "arm.urdf", "--test", "test.csv", "-o", "arm", "--quiet"];
    let done = run(folder.path(), &words);
    assert!(matches!(done.status, 0 | 4), "{}", done.messages);
    let json = std::fs::read(folder.path().join("arm/arm.json")).expect("arm.json is written");
    serde_json::from_slice(&json).expect("it is JSON")
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or(f64::NAN)
}
