//! Parameters of Rhoban's BAM on the command line: in, through the tools that take an image and a joint.toml, and out again.

use std::path::Path;

use frikan_tests::command::run;
use serde_json::Value;

/// About an XL330, all parameters of the friction model m6.
const M6: &str = r#"{"kt": 0.286, "R": 2.0, "armature": 0.0026, "q_offset": 0.0155, "friction_base": 0.0023, "friction_stribeck": 0.0012,
"load_friction_motor": 0.23, "load_friction_external": 0.26, "load_friction_motor_stribeck": 0.02, "load_friction_external_stribeck": 0.15,
"load_friction_motor_quad": 0.0056, "load_friction_external_quad": 0.0038, "dtheta_stribeck": 0.115, "alpha": 1.4,
"friction_viscous": 0.0185, "vin": 5, "model": "m6", "actuator": "xl330"}"#;

fn done(at: &Path, line: &str) -> String {
    let done = run(at, &line.split(' ').collect::<Vec<_>>());
    assert!(done.status <= 1, "{line}: {}", done.messages);
    done.output + &done.messages
}

fn json(at: &Path, name: &str) -> Value {
    serde_json::from_str(&std::fs::read_to_string(at.join(name)).unwrap()).unwrap()
}

/// Root mean square of the residual over that of the torque of the actuator.
fn residual_share(table: &str) -> f64 {
    let mut rows = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let header = rows.next().unwrap();
    let [torque, predicted, residual] = ["actuator_torque_Nm", "predicted_torque_Nm", "residual_Nm"]
        .map(|name| header.iter().position(|column| *column == name).unwrap());
    let (mut left, mut all) = (0.0, 0.0);
    for row in rows {
        let [torque, predicted, residual] =
            [torque, predicted, residual].map(|column| row[column].parse::<f64>().unwrap());
        assert!((torque - predicted - residual).abs() < 1e-6);
        left += residual * residual;
        all += torque * torque;
    }
    f64::sqrt(left / all)
}

#[test]
fn a_published_servo_is_simulated_rolled_out_looped_and_diagnosed() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("m6.json"), M6).unwrap();
    let hanging = "--supply 5 --firmware-kp 400 --payload-kg 0.2 --payload-m 0.08";
    let told = done(at, &format!("init m6.json -o servo.toml --image servo.frk {hanging}"));
    for words in ["q_offset of 15.5 mrad", "vin is no parameter of `m6`", "another one needs another image", "_quad"] {
        assert!(told.contains(words), "{words}: {told}");
    }
    assert!(done(at, "show servo.frk").contains("position"));
    done(at, "simulate servo.toml -o recorded.csv --duration 24 --quiet");
    let rolled = done(at, "rollout servo.frk recorded.csv --joint servo.toml --json rolled.json");
    let error = json(at, "rolled.json")["position"]["mae"].as_f64().unwrap();
    println!("rollout of the joint that BAM's friction moves: {error} rad");
    assert!(error < 0.01, "{rolled}");
    // The law reads the torque of the motor: what the actuator makes of its commands.
    done(at, "predict servo.frk recorded.csv --joint servo.toml -o predicted.csv --quiet");
    let share = residual_share(&std::fs::read_to_string(at.join("predicted.csv")).unwrap());
    println!("predict leaves {share} of the torque");
    assert!(share < 0.25, "{share}");
    // Without its friction of the load it is another joint.
    let text = std::fs::read_to_string(at.join("servo.toml")).unwrap();
    let without: Vec<&str> = text.lines().filter(|line| !line.starts_with("load_friction")).collect();
    std::fs::write(at.join("other.toml"), without.join("\n")).unwrap();
    done(at, "simulate other.toml -o other.csv --duration 24 --quiet");
    done(at, "rollout servo.frk other.csv --joint servo.toml --json other.json --quiet");
    let other = json(at, "other.json")["position"]["mae"].as_f64().unwrap();
    assert!(other > 2.0 * error, "{other} {error}");

    done(at, "loop servo.toml --image servo.frk --motion sine --duration 8 --json looped.json --quiet");
    let looped = json(at, "looped.json");
    let [without, with] = ["uncompensated", "compensated"].map(|run| looped[run]["rms_error"].as_f64().unwrap());
    println!("loop: {without} -> {with} rad");
    assert!(with < 0.95 * without, "{looped}");

    done(at, "diagnose recorded.csv --model servo.frk --joint servo.toml --json found.json --quiet");
    assert_ne!(json(at, "found.json")["verdict"], "bad_data");
}

#[test]
fn what_came_from_bam_goes_back_as_it_came() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("m6.json"), M6).unwrap();
    let surroundings = "--supply 5 --firmware-kp 400 --payload-kg 0.2 --payload-m 0.08";
    done(at, &format!("init m6.json -o servo.toml --image servo.frk {surroundings} --quiet"));
    done(at, "export servo.frk --to bam --joint servo.toml --joint-name xl330 -o again.json");
    let [given, back] = ["m6.json", "again.json"].map(|name| json(at, name));
    assert_eq!(back["model"], "m6");
    for (key, value) in given.as_object().unwrap() {
        let Some(value) = value.as_f64().filter(|_| !["vin", "q_offset"].contains(&key.as_str())) else { continue };
        let found = back[key].as_f64().unwrap();
        assert!((found - value).abs() <= 1e-6 * value, "{key}: {found} for {value}");
    }
    done(at, &format!("init again.json -o again.toml --image again.frk {surroundings} --quiet"));
    let [first, second] = ["servo.frk", "again.frk"].map(|name| std::fs::read(at.join(name)).unwrap());
    assert_eq!(first, second);
}

#[test]
fn what_cannot_be_taken_is_refused_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("m6.json"), M6).unwrap();
    std::fs::write(at.join("m7.json"), M6.replace("\"m6\"", "\"m7\"")).unwrap();
    std::fs::write(at.join("short.json"), M6.replace("\"alpha\": 1.4,", "")).unwrap();
    std::fs::write(at.join("log.csv"), "time_s,position_rad\n0,0\n1,1\n").unwrap();
    for (line, status, words) in [
        ("init m7.json -o joint.toml", 3, "m1, m2, m3, m4, m5, m6"),
        ("init short.json -o joint.toml", 3, "alpha"),
        ("init m6.json -o joint.toml --image servo.frk", 3, "--supply"),
        ("init m6.json -o joint.toml --supply 0", 2, "--supply"),
        ("init m6.json -o joint.toml --payload-kg 1", 2, "--payload-m"),
        ("init m6.json log.csv -o joint.toml", 2, "stands by itself"),
        ("init log.csv -o joint.toml --image servo.frk", 2, "parameter file of BAM"),
    ] {
        let refused = run(at, &line.split(' ').collect::<Vec<_>>());
        assert!(refused.status == status && refused.messages.contains(words), "{line}: {}", refused.messages);
        assert!(!at.join("joint.toml").exists() && !at.join("servo.frk").exists(), "{line}");
    }
}
