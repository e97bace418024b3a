//! `trainer loop` of joints that report no torque: the compensation reaches their actuators in the form that these take.

use std::path::Path;

use frikan_tests::command::run;
use frikan_tests::fixtures;
use serde_json::Value;

/// A joint of 10 g m2 with 0.2 N m of gravity and 0.08 N m of friction, sampled at 500 Hz.
const PLANT: &str = "[plant]\ninertia_kgm2 = 0.01\ngravity_torque_Nm = [0.2]\n[plant.friction]\ncoulomb_torque_Nm = 0.08\nviscous_Nm_s_rad = 0.02\n[plant.drive]\nrate_Hz = 500\n";
/// A servo of 1.8 N m/rad.
const SERVO: &str = "[actuator]\nkind = \"position_servo\"\ntorque_per_volt_Nm_V = 0.3\nback_emf_Nms_rad = 0.05\nsupply_V = 12\nfirmware_error_gain = 0.005\nfirmware_kp = 100\n";
const PD: &str = "[actuator]\nkind = \"pd\"\nkp_Nm_rad = 5\nkd_Nms_rad = 0.15\n";
const CURRENT: &str = "[actuator]\nkind = \"current\"\ntorque_constant_Nm_A = 0.4\n";
const MOTOR: &str =
    "[actuator]\nkind = \"dc_motor\"\ntorque_constant_Nm_A = 0.4\nresistance_ohm = 2.0\nsupply_V = 12\n";

fn joint(at: &Path, actuator: &str) -> String {
    std::fs::write(at.join("joint.toml"), format!("{actuator}{PLANT}")).unwrap();
    at.join("joint.toml").display().to_string()
}

fn json(at: &Path, actuator: &str, arguments: &[&str]) -> Value {
    let joint = joint(at, actuator);
    // The firmware is found from inside the checkout.
    let run = run(&fixtures::folder(), &[&["loop", joint.as_str(), "--json", "--quiet"], arguments].concat());
    assert_eq!(run.status, 0, "{actuator} {arguments:?}: {} {}", run.output, run.messages);
    serde_json::from_str(&run.output).unwrap()
}

/// Root mean square of the tracking error without and with compensation, rad.
fn errors(told: &Value) -> [f64; 2] {
    ["uncompensated", "compensated"].map(|run| told[run]["rms_error"].as_f64().unwrap())
}

#[test]
fn every_kind_of_actuator_is_followed_better_with_its_friction_compensated() {
    let folder = tempfile::tempdir().unwrap();
    for (actuator, more, form, per_torque) in [
        (SERVO, &[][..], "position_offset", 1.0 / 1.8),
        (PD, &[], "torque", 1.0),
        (PD, &["--feed-forward", "position_offset"], "position_offset", 0.2),
        (CURRENT, &[], "current", 2.5),
        (MOTOR, &[], "duty", 1.0 / 2.4),
        (MOTOR, &["--feed-forward", "voltage"], "voltage", 5.0),
    ] {
        for motion in ["reversals", "dwells", "sine", "creep"] {
            let line = [&["--motion", motion, "--duration", "8"], more].concat();
            let told = json(folder.path(), actuator, &line);
            let [without, with] = errors(&told);
            println!("{form:16} {motion:10} {:.3} -> {:.3} mrad", 1e3 * without, 1e3 * with);
            assert_eq!(told["feed_forward"], form);
            assert!((told["feed_forward_per_Nm"].as_f64().unwrap() - per_torque).abs() < 1e-12, "{told}");
            assert!(told["largest_feed_forward"].as_f64().unwrap() > 0.05 * per_torque, "{told}");
            assert!(with < 0.95 * without, "{actuator} {motion}: {told}");
        }
    }
}

#[test]
fn an_offset_makes_its_way_through_dead_band_sag_rate_and_delay() {
    let folder = tempfile::tempdir().unwrap();
    let plain = format!("{SERVO}dead_band_rad = 0.01\nresistance_ohm = 2.0\nsupply_resistance_ohm = 0.4\n");
    let late = format!("{plain}delay_s = 0.02\nvelocity_limit_rad_s = 3.0\n");
    for actuator in [plain, late] {
        for motion in ["reversals", "dwells", "sine"] {
            let [without, with] = errors(&json(folder.path(), &actuator, &["--motion", motion, "--duration", "8"]));
            println!("{motion:10} {:.3} -> {:.3} mrad", 1e3 * without, 1e3 * with);
            assert!(with < 0.95 * without, "{motion}: {without} {with}");
        }
    }
}

#[test]
fn a_servo_at_its_limit_is_never_followed_worse() {
    let folder = tempfile::tempdir().unwrap();
    // Gravity and friction together take 0.28 N m, at a stall of 0.18 and 0.07 N m, or a limit of 0.12 N m.
    for limit in ["duty_limit = 0.05\n", "duty_limit = 0.02\n", "torque_limit_Nm = 0.12\n"] {
        for motion in ["reversals", "dwells", "sine", "creep", "load-step"] {
            let line = ["--motion", motion, "--duration", "8"];
            let [without, with] = errors(&json(folder.path(), &format!("{SERVO}{limit}"), &line));
            println!("{limit:?} {motion:10} {:.3} -> {:.3} mrad", 1e3 * without, 1e3 * with);
            assert!(with <= 1.02 * without, "{limit} {motion}: {without} {with}");
        }
    }
}

#[test]
fn gravity_that_a_servo_holds_is_no_friction_to_the_supervisor() {
    let folder = tempfile::tempdir().unwrap();
    for actuator in [SERVO, PD] {
        let told = json(folder.path(), actuator, &["--motion", "sine", "--duration", "12", "--adapt"]);
        let level = told["correction"]["level"].as_f64().unwrap();
        assert!(level != 1.0 && (level - 1.0).abs() < 0.25, "{told}");
        assert!(told["lowest_gain_share"].as_f64().unwrap() > 0.5, "{told}");
    }
}

#[test]
fn an_emulated_drive_feeds_a_servo_as_the_host_does_bit_for_bit() {
    let folder = tempfile::tempdir().unwrap();
    let actuator = format!("{SERVO}dead_band_rad = 0.002\ndelay_s = 0.006\n");
    let line = ["--motion", "sine", "--adapt", "--duration", "4"];
    let on_host = json(folder.path(), &actuator, &line);
    let on_target = json(folder.path(), &actuator, &[&line[..], &["--target", "cortex-m4f"]].concat());
    assert_eq!(on_host["trace_crc32"], on_target["trace_crc32"], "{on_host} {on_target}");
    assert_eq!(on_target["target"], "cortex-m4f");
    assert_ne!(on_host["trace_crc32"], json(folder.path(), SERVO, &line)["trace_crc32"]);
}

#[test]
fn the_text_says_how_the_actuator_is_told_and_the_trace_what() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for (actuator, line, column) in [
        (
            SERVO,
            "the compensation alone as an offset of its position reference: 0.556 rad for each N m",
            "told_position_rad",
        ),
        (PD, "the compensation alone as a torque to add: 1 N m for each N m", "told_torque_Nm"),
        (CURRENT, "the drive's torque, compensation included, as a current: 2.5 A for each N m", "told_current_A"),
        (MOTOR, "the drive's torque, compensation included, as a duty: 0.417 for each N m", "told_duty"),
    ] {
        let joint = joint(at, actuator);
        let told = run(at, &["loop", &joint, "--duration", "3", "-o", "trace.csv", "--quiet"]);
        assert!(told.status == 0 && told.output.contains(line), "{} {}", told.output, told.messages);
        let trace = std::fs::read_to_string(at.join("trace.csv")).unwrap();
        let header = trace.lines().next().unwrap();
        assert!(header.ends_with(&format!(",status,{column}")), "{header}");
        let fields = header.split(',').count();
        assert!(trace.lines().all(|line| line.split(',').count() == fields));
        // It is a recording like any other.
        let followed = run(at, &["loop", &joint, "--motion", "trace.csv", "--duration", "2", "--quiet"]);
        assert_eq!(followed.status, 0, "{}", followed.messages);
    }
}

#[test]
fn what_cannot_be_run_is_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let open = SERVO.replace("supply_V = 12\n", "");
    let joint_of_open = joint(at, &open);
    let looped = run(at, &["loop", &joint_of_open, "--quiet"]);
    let simulated = run(at, &["simulate", &joint_of_open, "-o", "recording.csv", "--quiet"]);
    assert!(looped.status == 3 && looped.messages.contains("supply_V"), "{}", looped.messages);
    assert_eq!(looped.messages, simulated.messages);
    for (actuator, arguments, words) in [
        (SERVO, &["--feed-forward", "duty"][..], "position_offset"),
        (PD, &["--feed-forward", "current"], "torque or position_offset"),
        ("", &["--feed-forward", "position_offset"], "torque"),
        (SERVO, &["--feed-forward", "wish"], "voltage"),
        (SERVO, &["--motion", "nudge"], "holds its position"),
        (
            "[actuator]\nkind = \"pd\"\nkp_Nm_rad = 0\nkd_Nms_rad = 1\n",
            &["--feed-forward", "position_offset"],
            "kp_Nm_rad",
        ),
    ] {
        let joint = joint(at, actuator);
        let refused = run(at, &[&["loop", joint.as_str(), "-o", "trace.csv"], arguments].concat());
        assert!(refused.status == 2 && refused.messages.contains(words), "{arguments:?}: {}", refused.messages);
        assert!(!at.join("trace.csv").exists());
    }
}
