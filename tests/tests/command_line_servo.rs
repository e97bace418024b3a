//! Joints that report no torque: compared with a simulation by what they were commanded and where they went.

use std::f64::consts::TAU;
use std::fmt::Write as _;
use std::path::Path;

use frikan_tests::command::run;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};
use serde_json::Value;

/// What a pendulum and its drive do otherwise than the simulation.
#[derive(Clone, Copy)]
struct Joint {
    /// Friction per torque of the actuator.
    load: f64,
    /// N m/rad
    kp: f64,
    /// Largest torque, N m.
    limit: f64,
    /// Time until a command acts, s.
    delay: f64,
    /// Position error up to which the drive does nothing, rad.
    dead_band: f64,
    /// Deviation of the noise of the logged position, rad.
    noise: f64,
}

const AS_SIMULATED: Joint = Joint { load: 0.0, kp: 40.0, limit: f64::INFINITY, delay: 0.0, dead_band: 0.0, noise: 0.0 };

/// A pendulum under a PD command of 2 kHz, logged every 4 ms by an encoder of 16 bits: friction of 0.5 N m, and what the gear turns into
/// friction of the torque that it carries. Written apart from the program's own plant.
fn log(at: &Path, name: &str, joint: Joint, phase: f64) {
    const STEP_S: f64 = 5e-4;
    let waves = [(0.6, 0.5), (0.35, 1.3), (0.15, 2.9), (0.05, 5.3)].map(|(a, w): (f64, f64)| (a, w, phase * (1.0 + w)));
    let reference = |t: f64| waves.iter().map(|(a, w, p)| a * (w * t + p).sin()).sum::<f64>();
    let rate = |t: f64| waves.iter().map(|(a, w, p)| a * w * (w * t + p).cos()).sum::<f64>();
    let (mut q, mut v) = (reference(0.0), rate(0.0));
    let mut text = "time_s,position_rad,reference_position_rad,reference_velocity_rad_s\n".to_owned();
    let mut random = ChaCha8Rng::seed_from_u64(1);
    // Twelve uniform draws have a variance of one.
    let mut uniform = || f64::from(random.next_u32()) / f64::from(u32::MAX);
    let mut noise = || joint.noise * ((0..12).map(|_| uniform()).sum::<f64>() - 6.0);
    for i in 0..80_000 {
        let t = f64::from(i) * STEP_S;
        if i % 8 == 0 {
            let count = TAU / 65536.0;
            writeln!(text, "{t:.4},{:.9},{:.9},{:.9}", ((q + noise()) / count).round() * count, reference(t), rate(t))
                .unwrap();
        }
        let told = t - joint.delay;
        let error = reference(told) - q;
        let acted_upon = error - error.clamp(-joint.dead_band, joint.dead_band);
        let torque = (joint.kp * acted_upon + 1.5 * (rate(told) - v)).clamp(-joint.limit, joint.limit);
        let friction = (0.5 + joint.load * torque.abs()) * (v / 0.005).tanh() + 0.08 * v;
        v += STEP_S * (torque - friction - 1.2 * q.sin()) / 0.05;
        q += STEP_S * v;
    }
    std::fs::write(at.join(name), text).unwrap();
}

/// What a diagnosis of `real.csv` beside `simulation.csv` finds, each finding with what may stand in for it.
fn found(at: &Path, joint: &str) -> (Value, Vec<Vec<String>>) {
    found_against(at, joint, "--simulation simulation.csv")
}

/// The same against something else.
fn found_against(at: &Path, joint: &str, against: &str) -> (Value, Vec<Vec<String>>) {
    std::fs::write(at.join("joint.toml"), joint).unwrap();
    let words = format!("diagnose real.csv {against} --joint joint.toml --json told.json --quiet");
    let told = run(at, &words.split(' ').collect::<Vec<_>>());
    assert!(told.status <= 1, "{}", told.messages);
    let json: Value = serde_json::from_str(&std::fs::read_to_string(at.join("told.json")).unwrap()).unwrap();
    let name = |value: &Value| value["effect"].as_str().unwrap().to_owned();
    let set = |finding: &Value| {
        std::iter::once(name(finding)).chain(finding["alternatives"].as_array().unwrap().iter().map(name)).collect()
    };
    let sets = json["findings"].as_array().unwrap().iter().map(set).collect();
    (json, sets)
}

const KNOWN: &str = "[actuator]\nkind = \"pd\"\nkp_Nm_rad = 40\nkd_Nms_rad = 1.5\n";

#[test]
fn what_a_simulation_of_a_commanded_joint_leaves_out_is_named_from_positions() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    log(at, "simulation.csv", AS_SIMULATED, 0.3);
    // Recordings without any noise: what the encoder rounds is all that the two sides differ by.
    let healthy = [0.8, 1.7, 2.9, 4.1].map(|phase| {
        log(at, "real.csv", AS_SIMULATED, phase);
        let (json, sets) = found(at, KNOWN);
        assert_eq!(json["actuator"]["kp_Nm_rad"], 40.0);
        sets
    });
    assert!(healthy.iter().filter(|sets| !sets.is_empty()).count() <= 1, "{healthy:?}");

    log(at, "real.csv", Joint { load: 0.2, ..AS_SIMULATED }, 0.8);
    let (_, sets) = found(at, KNOWN);
    assert!(sets.iter().flatten().any(|name| name == "load_friction"), "{sets:?}");
}

/// Gain, delay, dead band and inertia all read the position, as the torque of the commands does. The simulation makes another motion: what it
/// does at one time is no event of the recording at that time.
#[test]
fn noise_of_the_position_is_no_effect_that_has_a_name() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    log(at, "simulation.csv", AS_SIMULATED, 0.3);
    for phase in [0.8, 1.7, 2.9, 4.1] {
        log(at, "real.csv", Joint { noise: 2e-4, ..AS_SIMULATED }, phase);
        let (_, sets) = found(at, KNOWN);
        assert!(sets.iter().flatten().all(|name| name == "unknown"), "{phase}: {sets:?}");
    }
}

/// The first parameter of a name among all findings.
fn parameter(json: &Value, name: &str) -> f64 {
    let findings = json["findings"].as_array().unwrap().iter();
    let mut parameters = findings.flat_map(|finding| finding["parameters"].as_array().unwrap());
    parameters
        .find(|parameter| parameter["name"] == name)
        .map_or(f64::NAN, |parameter| parameter["value"].as_f64().unwrap())
}

#[test]
fn what_the_actuator_does_otherwise_is_no_friction() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    log(at, "simulation.csv", AS_SIMULATED, 0.3);
    let cases = [
        ("actuator_gain", Joint { kp: 36.0, ..AS_SIMULATED }),
        ("supply_or_duty_limit", Joint { limit: 1.35, ..AS_SIMULATED }),
        ("command_delay", Joint { delay: 0.02, ..AS_SIMULATED }),
        ("dead_band", Joint { dead_band: 0.01, ..AS_SIMULATED }),
    ];
    for (effect, joint) in cases {
        log(at, "real.csv", joint, 1.7);
        let (json, sets) = found(at, KNOWN);
        assert!(sets.iter().all(|set| set.iter().any(|name| name == effect)), "{effect}: {sets:?}");
        assert!(!sets.is_empty(), "{effect}");
        let close = |name: &str, value: f64, by: f64| {
            let found = parameter(&json, name);
            assert!((found - value).abs() < by * value, "{name}: {found} for {value}");
        };
        match effect {
            "actuator_gain" => close("actuator_gain_error", 40.0 / 36.0 - 1.0, 0.05),
            "supply_or_duty_limit" => close("torque_limit", 1.35, 0.02),
            "dead_band" => close("dead_band", 0.01, 0.05),
            _ => {}
        }
    }
}

/// An image is that of a joint with the constants that were identified with it: other ones, identified anew, would make another torque.
#[test]
fn an_image_is_compared_with_by_the_constants_of_its_fit() {
    const OPEN: &str = "[actuator]\nkind = \"pd\"\nkp_Nm_rad = 40\n";
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    log(at, "fitted.csv", AS_SIMULATED, 0.3);
    std::fs::write(at.join("joint.toml"), OPEN).unwrap();
    let fit = "fit fitted.csv --joint joint.toml --form coulomb-viscous -o image.frk --quiet";
    let told = run(at, &fit.split(' ').collect::<Vec<_>>());
    assert_eq!(told.status, 0, "{}", told.messages);
    let constants: toml::Table = std::fs::read_to_string(at.join("image.actuator.toml")).unwrap().parse().unwrap();
    let identified = constants["actuator"]["kd_Nms_rad"].as_float().unwrap();

    let against = |joint: Joint| {
        log(at, "real.csv", joint, 1.7);
        found_against(at, OPEN, "--model image.frk")
    };
    let (json, sets) = against(AS_SIMULATED);
    assert_eq!(json["actuator"]["kd_Nms_rad"], identified);
    assert!(sets.is_empty(), "{sets:?}");
    let (_, sets) = against(Joint { load: 0.2, ..AS_SIMULATED });
    assert!(sets.first().is_some_and(|set| set.iter().any(|effect| effect == "load_friction")), "{sets:?}");
}

#[test]
fn a_servo_is_rehearsed_before_there_is_one() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    // Friction of 2 N m and 1.2 N m s/rad, an inertia of 0.5 kg m2: the default of the plant.
    // What the drive filters its velocity by is not in the law of the actuator, and is a part of what seems viscous.
    let joint = "[actuator]\nkind = \"pd\"\nkp_Nm_rad = 150\nkd_Nms_rad = 10\n[plant.control]\nvelocity_corner_Hz = 400\n[plant]\ngravity_torque_Nm = [6.0]\n";
    std::fs::write(at.join("joint.toml"), joint).unwrap();
    let simulated = run(at, &["simulate", "joint.toml", "-o", "real.csv", "--duration", "24", "--quiet"]);
    assert_eq!(simulated.status, 0, "{}", simulated.messages);
    let words = "fit real.csv --joint joint.toml -o model.frk --inputs velocity --json told.json --quiet";
    let fitted = run(at, &words.split(' ').collect::<Vec<_>>());
    assert_eq!(fitted.status, 0, "{}", fitted.messages);
    let json: Value = serde_json::from_str(&std::fs::read_to_string(at.join("told.json")).unwrap()).unwrap();
    let of = |name: &str| {
        let mut parameters = json["parameters"].as_array().unwrap().iter();
        parameters
            .find(|parameter| parameter["name"] == name)
            .map_or(f64::NAN, |parameter| parameter["value"].as_f64().unwrap())
    };
    // What `predict` leaves is what the fit was scored by, and what `check` looks at is what was fitted.
    let predicted = run(at, &["predict", "model.frk", "real.csv", "--joint", "joint.toml", "-o", "out.csv", "--quiet"]);
    assert_eq!(predicted.status, 0, "{}", predicted.messages);
    let table = std::fs::read_to_string(at.join("out.csv")).unwrap();
    assert!(table.lines().next().unwrap().ends_with("actuator_torque_Nm,predicted_torque_Nm,residual_Nm"));
    let residuals: Vec<f64> =
        table.lines().skip(1).map(|line| line.rsplit(',').next().unwrap().parse().unwrap()).collect();
    let left = f64::sqrt(residuals.iter().map(|residual| residual * residual).sum::<f64>() / residuals.len() as f64);
    let scored = json["train"]["rmse"].as_f64().unwrap();
    println!("predict leaves {left} N m, the fit was scored with {scored} N m");
    assert!((left / scored - 1.0).abs() < 0.02, "{left} {scored}");
    let checked = run(at, &["check", "real.csv", "--joint", "joint.toml", "--json", "-"]);
    let told: Value = serde_json::from_str(&checked.output).unwrap();
    assert_eq!((checked.status, &told["actuator"]["kp_Nm_rad"]), (0, &Value::from(150.0)), "{told}");
    let known = told["identifiable"].as_array().unwrap().iter();
    assert!(known.clone().any(|one| one["name"] == "Coulomb friction"), "{told}");
    // Without joint.toml the load, or the torque, is missing, and it is said what would tell it.
    let bare = run(at, &["check", "real.csv"]);
    assert!(bare.status == 3 && bare.output.contains("`[actuator]`"), "{}", bare.output);
    for (name, value, within) in
        [("coulomb_torque", 2.0, 0.02), ("viscous_coefficient", 1.2, 0.1), ("inertia", 0.5, 0.05)]
    {
        assert!((of(name) / value - 1.0).abs() < within, "{name}: {} for {value}", of(name));
    }
}

const PENDULUM: &str = r#"
[columns]
reference_position = "goal_position_rad"
[actuator]
preset = "XL330"
[payload]
mass_kg = 0.49
distance_m = 0.1
[recordings."*-kp100.csv"]
firmware_kp = 100
"#;

#[test]
fn a_servo_is_checked_by_the_torque_of_its_actuator() {
    let Some(recordings) = frikan_tests::recordings() else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let names = ["lift_and_drop", "sin_sin", "sin_time_square", "up_and_down"];
    let paths = names.map(|name| format!("{}/xl330_pendulum/{name}-kp100.csv", recordings.display()));
    let check = |joint: &str, rest: &[&str]| {
        std::fs::write(at.join("servo.toml"), joint).unwrap();
        let paths = paths.iter().map(String::as_str);
        run(at, &[&["check"][..], &paths.collect::<Vec<_>>(), &["--joint", "servo.toml"], rest].concat())
    };
    let checked = check(PENDULUM, &["--json", "-"]);
    assert_eq!(checked.status, 0, "{}", checked.messages);
    let told: Value = serde_json::from_str(&checked.output).unwrap();
    assert_eq!(told["verdict"], "usable");
    assert!(told["actuator"]["torque_per_volt_Nm_V"].as_f64().unwrap() > 0.0);
    let shares = [&told["identifiable"], &told["not_identifiable"]].map(|list| list.as_array().unwrap().len());
    assert!(shares[0] > 0, "{told}");
    // The same of all four recordings is one line, with each of them in it.
    let text = check(PENDULUM, &[]).output;
    let lines: Vec<&str> = text.lines().filter(|line| line.contains("FRK-W007")).collect();
    assert!(lines.len() == 1 && names.iter().all(|name| lines[0].contains(name)), "{text}");
    assert!(text.contains("FRK-W018") && !text.contains("FRK-D009"), "{text}");
    // With nothing that says how large the torque is, it is judged by the figures of the data sheet, and that is said.
    let open = PENDULUM.replace("[payload]\nmass_kg = 0.49\ndistance_m = 0.1\n", "");
    let text = check(&open, &[]).output;
    assert!(text.starts_with("usable") && text.contains("FRK-N005") && text.contains("0.1040"), "{text}");
}
