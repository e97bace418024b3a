//! Every command of the pages of `docs` runs as it stands there, in a folder where the files that it names are, and prints what is shown.

use std::collections::BTreeSet;
use std::path::PathBuf;

use frikan_tests::command::{checkout, printed};
use frikan_tests::fixtures::folder;
use frikan_tests::pages::commands::prints_what_it_shows;

/// Files that pages name and no command of theirs makes: page, name, and the fixture that is called so.
const FILES: [(&str, &str, &str); 16] = [
    ("command-line.md", "recording.csv", "stribeck.csv"),
    ("diagnosis.md", "real.csv", "elbow.csv"),
    ("diagnosis.md", "simulated.csv", "elbow-test.csv"),
    ("diagnosis.md", "joint.toml", "elbow.toml"),
    ("drive.md", "elbow.csv", "elbow.csv"),
    ("drive.md", "elbow.toml", "elbow.toml"),
    ("fit.md", "recording.csv", "elbow.csv"),
    ("fit.md", "joint.toml", "elbow.toml"),
    ("fit.md", "axis.csv", "stribeck.csv"),
    ("fit.md", "other-run.csv", "stribeck-test.csv"),
    ("fleet.md", "recordings/a.csv", "stribeck.csv"),
    ("fleet.md", "recordings/b.csv", "stribeck-test.csv"),
    ("recording.md", "recording.csv", "elbow.csv"),
    ("simulate.md", "joint.toml", "elbow.toml"),
    ("drive.md", "elbow.frk", "elbow.frk"),
    ("fit.md", "elbow.frk", "elbow.frk"),
];

/// Lines that make what the line of a page beginning so reads.
const BEFORE: [(&str, &str); 6] = [
    (
        "trainer export elbow.frk --to mujoco",
        r#"echo '<mujoco><worldbody><body><inertial pos="0 0 0" mass="1" diaginertia="0.1 0.1 0.1"/><joint name="elbow" axis="0 1 0"/></body></worldbody></mujoco>' > robot.xml"#,
    ),
    ("trainer export elbow.frk --to hex", "printf '%064d\n' 7 > drive.key"),
    (
        "trainer show dump.bin",
        "trainer export elbow.frk --to bin --address 0x08060000 --slot 7 --key-file drive.key --release 3 -o dump.bin",
    ),
    ("trainer loop servo.toml", SERVO),
    ("trainer init m6.json", BAM),
    ("trainer gather", "for task in 0 1; do trainer run --tasks tasks.jsonl --index $task; done"),
];

/// A servo of 1.8 N m/rad with a friction of 80 mN m.
const SERVO: &str = r#"printf '[actuator]
kind = "position_servo"
torque_per_volt_Nm_V = 0.3
back_emf_Nms_rad = 0.05
supply_V = 12
firmware_error_gain = 0.005
firmware_kp = 100
delay_s = 0.004
dead_band_rad = 0.002
[plant]
inertia_kgm2 = 0.01
gravity_torque_Nm = [0.2]
[plant.friction]
coulomb_torque_Nm = 0.08
viscous_Nm_s_rad = 0.02
[plant.drive]
rate_Hz = 500
' > servo.toml"#;

/// Parameters of a servo as BAM writes them, about those of an XL330.
const BAM: &str = r#"echo '{"kt": 0.286, "R": 2.0, "armature": 0.0026, "q_offset": 0.0155, "friction_base": 0.0023, "friction_stribeck": 0.0002,
"load_friction_motor": 0.23, "load_friction_external": 0.26, "load_friction_motor_stribeck": 0.0, "load_friction_external_stribeck": 0.15,
"load_friction_motor_quad": 0.0056, "load_friction_external_quad": 0.0038, "dtheta_stribeck": 0.115, "alpha": 1.0, "friction_viscous": 0.0185,
"model": "m6", "actuator": "xl330"}' > m6.json"#;

/// Lines that are not run here, by what they begin with, and why.
const ELSEWHERE: [(&str, &str); 16] = [
    ("trainer arm", "tests/arm.rs and the tests of the Python package identify arms"),
    ("trainer fit a-kp100.csv", "trainer/src/servo and tests/rollout.rs fit servos, which takes minutes"),
    ("trainer rollout servo.frk", "tests/rollout.rs"),
    ("trainer check a-kp100.csv", "tests/command_line_servo.rs; the recordings are a servo's"),
    ("trainer predict servo.frk", "tests/command_line_servo.rs"),
    (
        "trainer diagnose real.csv --simulation simulated.csv --joint servo.toml",
        "tests/command_line_servo.rs; the recordings are a servo's",
    ),
    ("hq submit", "tests/fleet runs HyperQueue and Slurm"),
    ("trainer watch", "tests/command_line_watch.rs; it ends by an interrupt alone"),
    ("trainer verify elbow.frk --target cortex-m4f", "tests/emulation.rs"),
    ("trainer verify counts.frk --target cortex-m0plus", "tests/emulation_integer.rs"),
    (
        "trainer loop fixtures/elbow.toml --effect presliding=2 --image improved.frk --target cortex-m4f",
        "tests/emulation_steps.rs",
    ),
    ("trainer diagnose emps/", "`real-recordings` writes that page from other people's recordings"),
    ("trainer diagnose odrive_cogging/", "`real-recordings`"),
    ("trainer diagnose tribometer/", "`real-recordings`"),
    ("trainer diagnose kr300/", "`real-recordings`"),
    ("trainer diagnose xl330_pendulum/", "`real-recordings`"),
];

fn docs() -> PathBuf {
    folder().join("../docs")
}

#[test]
fn every_command_of_a_page_runs() {
    let pages = std::fs::read_dir(docs()).unwrap().map(|entry| entry.unwrap().path());
    let mut pages: Vec<PathBuf> = pages.filter(|path| path.extension().is_some_and(|ending| ending == "md")).collect();
    // Tests in readme.rs run the commands of that page.
    pages.retain(|path| !path.ends_with("demo.md"));
    pages.sort();
    let mut left_out = BTreeSet::new();
    let mut run = 0;
    for page in &pages {
        let checkout = checkout();
        let at = checkout.path();
        let name = page.file_name().unwrap().to_string_lossy();
        for (_, file, fixture) in FILES.iter().filter(|(of, ..)| *of == name) {
            std::fs::create_dir_all(at.join(file).parent().unwrap()).unwrap();
            std::fs::copy(folder().join(fixture), at.join(file)).unwrap();
        }
        let print = |line: &str| {
            if let Some((start, _)) = ELSEWHERE.iter().find(|(start, _)| line.starts_with(start)) {
                left_out.insert(*start);
                return None;
            }
            for (_, before) in BEFORE.iter().filter(|(start, _)| line.starts_with(start)) {
                let _ = printed(at, before);
            }
            Some(printed(at, line))
        };
        run += prints_what_it_shows(page, print);
    }
    assert!(run >= 30, "{run} commands");
    let unused: Vec<_> = ELSEWHERE.iter().filter(|(start, _)| !left_out.contains(start)).collect();
    assert!(unused.is_empty(), "no page has these lines any more: {unused:?}");
}
