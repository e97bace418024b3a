//! `trainer diagnose --simulation` with a simulator that names its columns differently, or gives joint torque beside a motor current.

use std::fmt::Write;
use std::path::Path;

use frikan_tests::command::{Run, run};
use serde_json::Value;

/// Rows of 5 ms.
const ROWS: usize = 6000;

/// Coulomb friction of the joint, N m, the other constants being the same for recording and simulation.
const REAL_COULOMB: f64 = 1.6;
const SIMULATED_COULOMB: f64 = 0.8;

/// Joint torque of an ampere: torque constant times gear ratio, N m/A.
const DRIVE: &str = "[drive]\ntorque_constant_Nm_A = 0.05\ngear_ratio = 40\n";
const TORQUE_PER_AMPERE: f64 = 2.0;

/// A joint under two sines, as a table with these columns; the last one is the torque divided by `divisor`.
fn motion(columns: &str, coulomb: f64, (noise, divisor): (f64, f64)) -> String {
    let mut text = format!("{columns}\n");
    let mut random = 1u32;
    for row in 0..ROWS {
        let t = 0.005 * row as f64;
        let (a, b) = (1.1 * t, 3.7 * t);
        let position = 0.7 * a.sin() + 0.15 * b.sin();
        let velocity = 0.77 * a.cos() + 0.555 * b.cos();
        let acceleration = -0.847 * a.sin() - 2.0535 * b.sin();
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let noise = noise * (f64::from(random >> 8) / f64::from(1 << 24) - 0.5);
        let friction = coulomb * (velocity / 0.005).tanh() + 0.7 * velocity;
        let torque = 0.3 * acceleration + 3.0 * position.sin() + friction + noise;
        writeln!(text, "{t},{position},{velocity},{}", torque / divisor).unwrap();
    }
    text
}

fn diagnose(folder: &Path, joint: &str) -> Run {
    std::fs::write(folder.join("joint.toml"), joint).unwrap();
    let words = "diagnose real.csv --simulation simulated.csv --joint joint.toml --quiet --json d.json -o better.frk";
    run(folder, &words.split(' ').collect::<Vec<_>>())
}

/// Whether the level of friction is what is missing, or told as given.
fn names_the_level(folder: &Path) -> bool {
    let told: Value = serde_json::from_slice(&std::fs::read(folder.join("d.json")).unwrap()).unwrap();
    told.to_string().contains("coulomb") || told.to_string().contains("Coulomb")
}

#[test]
fn recording_and_simulation_have_maps_of_their_own() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::write(at.join("real.csv"), motion("t,position[1],dq,effort", REAL_COULOMB, (0.2, 1.0))).unwrap();
    std::fs::write(at.join("simulated.csv"), motion("time,qpos,qvel,qfrc", SIMULATED_COULOMB, (0.0, 1.0))).unwrap();
    let real = "[columns]\ntime = \"t\"\nposition = \"position[1]\"\nvelocity = \"dq\"\ntorque = \"effort\"\n";
    let simulated =
        "[simulation.columns]\ntime = \"time\"\nposition = \"qpos\"\nvelocity = \"qvel\"\ntorque = \"qfrc\"\n";
    let mapped = diagnose(at, &format!("{real}{simulated}"));
    assert!(matches!(mapped.status, 0 | 1), "{}", mapped.messages);
    assert!(names_the_level(at), "{}", mapped.output);

    // A column that is not there is named with its file.
    let wrong = diagnose(at, &format!("{real}{}", simulated.replace("qvel", "speed")));
    assert_eq!(wrong.status, 3, "{}", wrong.messages);
    assert!(wrong.messages.contains("simulated.csv") && wrong.messages.contains("speed"), "{}", wrong.messages);

    // Columns that nobody knows are to be said where those of the simulation stand.
    std::fs::write(at.join("simulated.csv"), motion("a,b,c,d", SIMULATED_COULOMB, (0.0, 1.0))).unwrap();
    let unknown = diagnose(at, real);
    assert!(unknown.messages.contains("say what they are under [simulation.columns]"), "{}", unknown.messages);
    std::fs::write(at.join("real.csv"), motion("a,b,c,d", REAL_COULOMB, (0.2, 1.0))).unwrap();
    let unknown = diagnose(at, "");
    assert!(unknown.messages.contains("say what they are under [columns]"), "{}", unknown.messages);
    std::fs::write(at.join("real.csv"), motion("t,position[1],dq,effort", REAL_COULOMB, (0.2, 1.0))).unwrap();

    // Without a map of its own the simulation is read by [columns] as far as they fit, else by the standard names.
    let standard = motion("time_s,position_rad,dq,torque_Nm", SIMULATED_COULOMB, (0.0, 1.0));
    std::fs::write(at.join("simulated.csv"), standard).unwrap();
    let shared = diagnose(at, real);
    assert!(matches!(shared.status, 0 | 1) && names_the_level(at), "{}", shared.messages);
}

#[test]
fn a_simulation_in_joint_torque_stands_beside_a_current() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let columns = "time_s,position_rad,velocity_rad_s,";
    let current = motion(&format!("{columns}current_A"), REAL_COULOMB, (0.2, TORQUE_PER_AMPERE));
    std::fs::write(at.join("real.csv"), current).unwrap();
    let torque = motion(&format!("{columns}torque_Nm"), SIMULATED_COULOMB, (0.0, 1.0));
    std::fs::write(at.join("simulated.csv"), torque).unwrap();

    let unknown = diagnose(at, "");
    assert_eq!(unknown.status, 3, "{}", unknown.messages);
    assert!(unknown.messages.contains("torque_constant_Nm_A"), "{}", unknown.messages);

    let known = diagnose(at, DRIVE);
    assert!(matches!(known.status, 0 | 1), "{}", known.messages);
    let show = run(at, &["predict", "better.frk", "real.csv", "-o", "out.csv"]);
    assert_eq!(show.status, 0, "{}", show.messages);
    let out = std::fs::read_to_string(at.join("out.csv")).unwrap();
    let mut lines = out.lines();
    let place = lines.next().unwrap().split(',').position(|name| name == "residual_A").unwrap();
    let residuals: Vec<f64> = lines.map(|line| line.split(',').nth(place).unwrap().parse().unwrap()).collect();
    let rms = (residuals.iter().map(|r| r * r).sum::<f64>() / residuals.len() as f64).sqrt();
    // The noise is uniform over 0.2 N m, which is 0.029 A rms; half the difference of the frictions would be 0.2 A.
    assert!(rms < 0.06, "{rms} A");
}
