//! `trainer diagnose` on the command line: what it is compared with, what it advises, and bad or scarce data.

use std::path::Path;

use frikan_tests::command::{Run, run};
use frikan_tests::exhaustive;
use serde_json::Value;

/// A folder with the elbow of the fixtures: as it is, sampled more slowly, with half as much friction again, without noise, moved
/// little, and at rest.
fn bench() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let fixtures = Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures");
    let elbow = std::fs::read_to_string(fixtures.join("elbow.toml")).unwrap();
    let moved = |motion: &str| {
        let (joint, _) = elbow.split_once("[[plant.campaign.trajectories]]").unwrap();
        format!("{joint}[[plant.campaign.trajectories]]\nmotion = {motion}\n{LIMITS}")
    };
    for (name, text) in [
        ("joint.toml", elbow.clone()),
        ("slower.toml", elbow.replace("rate_Hz = 250.0", "rate_Hz = 180.0")),
        ("rougher.toml", elbow.replace("coulomb_torque_Nm = 2.0", "coulomb_torque_Nm = 3.0")),
        ("frictionless.toml", frictionless(&elbow)),
        ("quiet.toml", elbow.replace("white_torque_Nm = 0.1", "white_torque_Nm = 0.0\ncoloured_torque_Nm = 0.0")),
        ("narrow.toml", moved(NARROW)),
        ("rest.toml", moved("{ kind = \"rest\" }")),
    ] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// The elbow as a simulation without friction.
fn frictionless(elbow: &str) -> String {
    let friction = [("coulomb_torque_Nm", "2.0"), ("viscous_Nm_s_rad", "1.2"), ("stribeck_torque_Nm", "1.0")];
    friction
        .iter()
        .fold(elbow.to_owned(), |text, (key, value)| text.replace(&format!("{key} = {value}"), &format!("{key} = 0.0")))
}

const NARROW: &str =
    "{ kind = \"multisine\", amplitude_rad = 0.35, lowest_Hz = 0.3, highest_Hz = 1.2, speed_rad_s = 2.5, lines = 5 }";
const LIMITS: &str = "[limits]\nlowest_position_rad = -1.5\nhighest_position_rad = 1.5\nvelocity_rad_s = 3\n\
                      acceleration_rad_s2 = 20\n";

fn simulate(folder: &Path, arguments: &str) {
    let words: Vec<&str> = ["simulate", "--quiet"].into_iter().chain(arguments.split_whitespace()).collect();
    let made = run(folder, &words);
    assert_eq!(made.status, 0, "{}", made.messages);
}

fn diagnose(folder: &Path, arguments: &str) -> Run {
    let words: Vec<&str> = ["diagnose", "--quiet"].into_iter().chain(arguments.split_whitespace()).collect();
    run(folder, &words)
}

/// Writes `to` from the rows of `from`, field by field.
fn rewrite(folder: &Path, from: &str, to: &str, change: impl Fn(&[&str]) -> String) {
    let text = std::fs::read_to_string(folder.join(from)).unwrap();
    let lines: Vec<String> = text.lines().map(|line| change(&line.split(',').collect::<Vec<_>>())).collect();
    std::fs::write(folder.join(to), lines.join("\n") + "\n").unwrap();
}

#[test]
fn a_simulation_may_be_shorter_later_or_sampled_differently() {
    let folder = bench();
    let at = folder.path();
    simulate(at, "joint.toml --effect spring=1 --duration 40 --seed 3 -o real.csv");
    simulate(at, "joint.toml --duration 40 --seed 3 -o same.csv");
    simulate(at, "joint.toml --duration 12 --seed 4 -o shorter.csv");
    simulate(at, "slower.toml --duration 40 --seed 5 -o slower.csv");
    rewrite(at, "same.csv", "later.csv", |fields| match fields[0].parse::<f64>() {
        Ok(time) => format!("{:.4},{}", time + 1000.0, fields[1..].join(",")),
        Err(_) => fields.join(","),
    });
    for simulation in ["same.csv", "later.csv", "shorter.csv", "slower.csv"] {
        let told = diagnose(at, &format!("real.csv --simulation {simulation} --json -"));
        assert_eq!((told.status, told.messages.as_str()), (1, ""), "{simulation}");
        let json: Value = serde_json::from_str(&told.output).unwrap();
        // The gravity of a simulation of 12 s is not sure enough to tell a spring from a part of it.
        let first = &json["findings"][0];
        let is_rival = || first["alternatives"][0]["effect"] == "spring" && simulation == "shorter.csv";
        assert!(first["effect"] == "spring" || is_rival(), "{simulation}: {first}");
        let ratio = json["fit"]["held_out"]["ratio"].as_f64().unwrap();
        assert!(ratio < 0.4, "{simulation}: {ratio}");
        let rollout = &json["fit"]["rollout"];
        assert!(rollout["improved_rmse"].as_f64() < rollout["baseline_rmse"].as_f64(), "{simulation}: {rollout}");
    }
}

#[test]
fn a_simulation_that_is_right_leaves_nothing_to_find() {
    let folder = bench();
    for seed in 9..if exhaustive() { 15 } else { 12 } {
        simulate(folder.path(), &format!("joint.toml --duration 40 --seed {seed} -o real.csv"));
        let told = diagnose(folder.path(), "real.csv --simulation real.csv");
        assert_eq!((told.status, told.messages.as_str()), (0, ""), "{}", told.output);
        assert!(told.output.starts_with("Nothing is missing"), "seed {seed}: {}", told.output);
    }
}

/// A simulation whose Coulomb friction is wrong by a third, or that has no friction at all, is told by how much and with what would
/// be right; one that is right is not.
#[test]
fn a_wrong_friction_level_of_a_simulation_is_a_finding_with_the_level_of_the_joint() {
    let folder = bench();
    let at = folder.path();
    simulate(at, "rougher.toml --duration 40 --seed 3 -o real.csv");
    for (simulation, change) in [("joint", 1.0), ("frictionless", 3.0), ("rougher", 0.0)] {
        simulate(at, &format!("{simulation}.toml --duration 40 --seed 7 -o simulated.csv"));
        let told = diagnose(at, "real.csv --simulation simulated.csv --json - --report page.html");
        assert_eq!((told.status, told.messages.as_str()), (i32::from(change > 0.0), ""), "{}", told.output);
        let json: Value = serde_json::from_str(&told.output).unwrap();
        let moved = &json["base_parameters"][0];
        assert_eq!((&moved["name"], &moved["unit"]), (&"coulomb_torque_change".into(), &"N m".into()));
        assert!((moved["value"].as_f64().unwrap() - change).abs() < 0.1, "{simulation}: {moved}");
        let Some(found) = json["findings"].get(0) else { continue };
        assert_eq!(found["effect"], "friction_level", "{simulation}");
        let parameters = found["parameters"].as_array().unwrap();
        let coulomb = parameters.iter().find(|parameter| parameter["name"] == "coulomb_torque").unwrap();
        assert!((coulomb["value"].as_f64().unwrap() - 3.0).abs() < 0.1, "{simulation}: {coulomb}");
        let [before, after] = ["baseline", "improved"].map(|which| json["fit"][which]["rmse"].as_f64().unwrap());
        assert!(before > 0.9 * change && after < 0.15, "{simulation}: {before} {after}");
        let page = std::fs::read_to_string(at.join("page.html")).unwrap();
        assert!(
            page.contains("Wrong level of Coulomb or viscous friction") && page.contains(">coulomb torque</td>"),
            "{page}"
        );
        assert!(page.contains("trainer export IMPROVED.frk --to mujoco --into MODEL.xml --joint-name"), "{page}");
    }
}

/// A simulation of the same joint tells the transmission beside a rigid body that only its own law knows: the law held none of it,
/// and of play the comparison ended in a panic.
#[test]
fn an_elastic_gear_or_play_is_part_of_the_law_of_its_simulation() {
    let folder = bench();
    let at = folder.path();
    for (effect, largest_error) in [("elasticity=3", Some(1.1)), ("backlash=1", None)] {
        simulate(at, &format!("joint.toml --effect {effect} --duration 120 --seed 9 -o both.csv"));
        for (name, half) in [("real.csv", 0.0..60.0), ("simulated.csv", 60.0..120.0)] {
            let text = std::fs::read_to_string(at.join("both.csv")).unwrap();
            let is_in =
                |line: &&str| line.split(',').next().unwrap().parse::<f64>().map_or(true, |t| half.contains(&t));
            let lines: Vec<&str> = text.lines().filter(is_in).collect();
            std::fs::write(at.join(name), lines.join("\n") + "\n").unwrap();
        }
        let told = diagnose(at, "real.csv --simulation simulated.csv --json -");
        assert!(told.status <= 1, "{effect}: {}", told.messages);
        let json: Value = serde_json::from_str(&told.output).unwrap();
        assert!(!json["given"]["holds"].as_array().unwrap().is_empty(), "{effect}");
        let (error, noise) = (json["given"]["rmse"].as_f64().unwrap(), json["fit"]["noise_rmse"].as_f64().unwrap());
        assert!(largest_error.is_none_or(|largest| error < largest * noise), "{effect}: {error} beside {noise}");
    }
}

/// A rigid body of the joint file is in N m: it was taken off a current as it is, and off friction that was separated before.
#[test]
fn a_given_rigid_body_counts_in_the_unit_of_the_actuator_and_not_beside_separated_friction() {
    const BODY: &str = "[rigid_body]\ninertia_kgm2 = 0.5\ngravity_torque_Nm = 6.0\n";
    let folder = bench();
    let at = folder.path();
    simulate(at, "joint.toml --duration 40 --seed 3 -o torque.csv");
    let place = |name: &str| {
        let header = std::fs::read_to_string(at.join("torque.csv")).unwrap();
        header.lines().next().unwrap().split(',').position(|column| column == name).unwrap()
    };
    let (torque, position) = (place("torque_Nm"), place("position_rad"));
    let with = |to: &str, column: &str, change: &dyn Fn(f64, f64) -> f64| {
        rewrite(at, "torque.csv", to, |fields| {
            let mut fields: Vec<String> = fields.iter().map(|field| (*field).to_owned()).collect();
            fields[torque] = match fields[torque].parse::<f64>() {
                Ok(value) => change(value, fields[position].parse().unwrap()).to_string(),
                Err(_) => column.to_owned(),
            };
            fields.join(",")
        });
    };
    with("current.csv", "current_A", &|torque, _| torque / 8.0);
    with("friction.csv", "friction_torque_Nm", &|torque, position| torque - 6.0 * position.sin());
    std::fs::write(at.join("body.toml"), BODY).unwrap();
    std::fs::write(at.join("drive.toml"), format!("{BODY}[drive]\ntorque_constant_Nm_A = 8.0\n")).unwrap();

    let told = |arguments: &str| -> Value {
        let told = diagnose(at, &format!("{arguments} --json -"));
        assert!(told.status <= 1, "{arguments}: {}", told.messages);
        serde_json::from_str(&told.output).unwrap()
    };
    let error = |told: &Value| told["fit"]["baseline"]["rmse"].as_f64().unwrap();
    let names = |told: &Value| -> Vec<String> {
        told["findings"].as_array().unwrap().iter().map(|finding| finding["effect"].to_string()).collect()
    };
    let by_torque = told("torque.csv --joint body.toml");
    let by_current = told("current.csv --joint drive.toml -o current.frk");
    assert!((error(&by_torque) / (8.0 * error(&by_current)) - 1.0).abs() < 1e-3, "{by_torque} {by_current}");
    assert_eq!(names(&by_torque), names(&by_current));
    let image = run(at, &["export", "current.frk", "--to", "json", "-o", "-"]);
    let image: Value = serde_json::from_str(&image.output).unwrap();
    assert!((image["rigid_body"]["gravity_sin"].as_f64().unwrap() - 6.0 / 8.0).abs() < 0.05, "{image}");
    let refused = diagnose(at, "current.csv --joint body.toml");
    assert_eq!(refused.status, 3);
    assert!(refused.messages.contains("FRK-D014"), "{}", refused.messages);

    let [alone, beside] = ["friction.csv", "friction.csv --joint body.toml"].map(told);
    assert_eq!(error(&alone), error(&beside));
}

/// The simulator's own effect is part of what the drive gets, and the recording may have less of it.
#[test]
fn what_a_simulator_holds_too_much_of_is_said_and_its_effects_reach_the_image() {
    let folder = bench();
    let at = folder.path();
    simulate(at, "joint.toml --effect presliding=0.5 --duration 40 --seed 3 -o real.csv");
    for (name, amplitude) in [("same", 0.5), ("stronger", 1.5)] {
        simulate(at, &format!("quiet.toml --effect presliding={amplitude} --duration 40 --seed 3 -o {name}.csv"));
    }
    let same = diagnose(at, "real.csv --simulation same.csv -o same.frk");
    assert_eq!(same.status, 0, "{}", same.output);
    assert!(same.output.contains("Found in the simulation itself, and so not missing from it: presliding"));
    let shown = run(at, &["show", "same.frk"]);
    assert!(shown.output.contains("effect      presliding: sum of torque_i"), "{}", shown.output);
    let stronger = diagnose(at, "real.csv --simulation stronger.csv --json -");
    let json: Value = serde_json::from_str(&stronger.output).unwrap();
    assert_eq!(json["given"]["holds"][0], "presliding");
    assert_eq!(json["findings"][0]["effect"], "presliding");
    let sentence = json["findings"][0]["sentence"].as_str().unwrap();
    assert!(sentence.contains(" more: presliding hysteresis"), "the real joint yields less: {sentence}");
}

/// A model that was improved keeps its effects where it is improved again, whatever its law is: what comes of it leaves what the
/// second diagnosis leaves.
#[test]
fn an_improved_model_is_improved_again() {
    let folder = bench();
    let at = folder.path();
    simulate(at, "joint.toml --effect position_friction=1 --duration 60 --seed 4 -o first.csv");
    simulate(
        at,
        "joint.toml --effect position_friction=1 --effect torque_offset=1 --duration 60 --seed 5 -o second.csv",
    );
    let told = |arguments: &str| -> Value {
        let told = diagnose(at, &format!("{arguments} --joint joint.toml --target host --json -"));
        assert!(told.status <= 1 && told.messages.is_empty(), "{arguments}: {}{}", told.output, told.messages);
        serde_json::from_str(&told.output).unwrap()
    };
    let names = |told: &Value, effect: &str| told["findings"].as_array().unwrap().iter().any(|f| f["effect"] == effect);
    let left = |told: &Value, model: &str| told["fit"][model]["rmse"].as_f64().unwrap();
    assert!(names(&told("first.csv -o table.frk"), "position_friction"));
    let fitted = run(at, &["fit", "--quiet", "first.csv", "--joint", "joint.toml", "-o", "law.frk"]);
    assert_eq!(fitted.status, 0, "{}", fitted.messages);
    assert!(names(&told("first.csv --model law.frk -o formula.frk"), "position_friction"));
    for model in ["table", "formula"] {
        let second = told(&format!("second.csv --model {model}.frk -o again.frk"));
        // An offset is an asymmetry where nothing rests, and part of a spring with a preload: the rigid body of a law that was fitted beside
        // other physics errs like one.
        let offsets = ["torque_offset", "direction_asymmetry", "spring"];
        assert!(offsets.iter().any(|name| names(&second, name)), "{model}: {second}");
        let third = told("second.csv --model again.frk");
        let (before, after) = (left(&second, "improved"), left(&third, "baseline"));
        assert!(after < 1.15 * before, "{model}: the diagnosis leaves {before}, the image {after}");
    }
}

#[test]
fn missing_channels_rest_and_two_seconds_are_answered_clearly() {
    let folder = bench();
    let at = folder.path();
    simulate(at, "joint.toml --effect spring=1 --duration 40 --seed 3 -o real.csv");
    simulate(at, "joint.toml --duration 2 --seed 3 -o two_seconds.csv");
    simulate(at, "rest.toml --duration 12 -o rest.csv");
    rewrite(at, "real.csv", "no_torque.csv", |fields| fields[..2].join(","));
    rewrite(at, "real.csv", "no_position.csv", |fields| format!("{},{}", fields[0], fields[2]));
    rewrite(at, "real.csv", "current.csv", |fields| fields.join(",").replace("torque_Nm", "current_A"));
    for (arguments, status, message) in [
        ("no_torque.csv", 3, "no_torque.csv:1:torque_Nm: FRK-D009"),
        ("no_position.csv", 3, "no_position.csv:1:position_rad: FRK-D009"),
        ("rest.csv", 3, "rest.csv: FRK-D017"),
        ("two_seconds.csv", 3, "two_seconds.csv: FRK-D017"),
        ("real.csv --simulation no_torque.csv", 3, "no_torque.csv:1:torque_Nm: FRK-D009"),
        ("real.csv --simulation rest.csv", 3, "rest.csv: FRK-D016"),
        ("real.csv --simulation two_seconds.csv", 3, "two_seconds.csv: FRK-D016"),
        ("real.csv --simulation current.csv", 3, "current.csv: FRK-D018"),
        ("rest.csv --simulation real.csv", 3, "rest.csv: FRK-D016"),
        ("real.csv absent.csv", 5, "absent.csv: FRK-I002"),
    ] {
        let told = diagnose(at, &format!("{arguments} -o out.frk --json out.json"));
        assert_eq!(told.status, status, "{arguments}: {told:?}");
        assert!(told.messages.starts_with(message), "{arguments}: {}", told.messages);
        assert!(told.output.is_empty() && !at.join("out.frk").exists() && !at.join("out.json").exists(), "{arguments}");
    }
}

#[test]
fn advice_is_a_trajectory_within_the_limits() {
    let folder = bench();
    let at = folder.path();
    simulate(at, "narrow.toml --effect spring=2 --duration 40 --seed 3 -o real.csv");
    let told = diagnose(at, "real.csv --joint narrow.toml --advise next.csv --json -");
    assert_eq!(told.status, 1, "{}", told.messages);
    let json: Value = serde_json::from_str(&told.output).unwrap();
    let advice = &json["advice"];
    assert!(advice["expected_margin_nats"].as_f64() > advice["present_margin_nats"].as_f64(), "{advice}");
    assert!(json["findings"][0]["separate_by"].as_str().unwrap().contains("expected margin"));
    let text = std::fs::read_to_string(at.join("next.csv")).unwrap();
    let mut rows = text.lines();
    assert_eq!(rows.next(), Some("time_s,position_rad,velocity_rad_s,acceleration_rad_s2"));
    let mut before = f64::NEG_INFINITY;
    let mut reach = 0.0f64;
    for row in rows {
        let fields: Vec<f64> = row.split(',').map(|field| field.parse().unwrap()).collect();
        let [time, position, velocity, acceleration] = fields[..] else { panic!("{row}") };
        assert!(time > before && position.abs() <= 1.5 && velocity.abs() <= 3.0 && acceleration.abs() <= 20.5, "{row}");
        (before, reach) = (time, reach.max(position.abs()));
    }
    // Gravity and a spring differ only where the sine bends.
    assert!(reach > 1.2, "{reach}");
    // The recording of the advised motion goes behind the first one.
    let both = diagnose(at, "real.csv real.csv --json -");
    let json: Value = serde_json::from_str(&both.output).unwrap();
    assert_eq!((both.status, &json["schema"]), (1, &Value::from("frikan.diagnose/1")), "{}", both.messages);
}

/// A torque that was never measured was explained by a torque scale of -1, and written into an improved model.
#[test]
fn what_the_measurement_got_wrong_is_told_and_no_model_is_written() {
    let folder = bench();
    let at = folder.path();
    simulate(at, "joint.toml --duration 20 --seed 3 -o real.csv");
    let header = std::fs::read_to_string(at.join("real.csv")).unwrap();
    let header: Vec<&str> = header.lines().next().unwrap().split(',').collect();
    let place = |name: &str| header.iter().position(|column| *column == name).unwrap();
    let (position, torque) = (place("position_rad"), place("torque_Nm"));
    rewrite(at, "real.csv", "still.csv", |fields| {
        let mut fields = fields.to_vec();
        if fields[torque] != "torque_Nm" {
            fields[torque] = "0";
        }
        fields.join(",")
    });
    let before = std::cell::Cell::new(f64::NAN);
    rewrite(at, "real.csv", "turned.csv", |fields| {
        let velocity = match fields[position].parse::<f64>() {
            Ok(now) => {
                let step = now - before.replace(now);
                if step.is_nan() { "0".to_string() } else { (-250.0 * step).to_string() }
            }
            Err(_) => "velocity_rad_s".to_string(),
        };
        format!("{},{},{},{velocity}", fields[place("time_s")], fields[position], fields[torque])
    });
    for (recording, sentence) in [("still.csv", "was not measured"), ("turned.csv", "as between two directions")] {
        let told = diagnose(at, &format!("{recording} --joint joint.toml -o better.frk"));
        let all = told.output + &told.messages;
        assert!(told.status == 3 && all.contains(sentence), "{recording}: {all}");
        assert!(!at.join("better.frk").exists());
    }
}
