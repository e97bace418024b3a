//! Rows that no joint can have made are told and replaced; nothing that a joint does is taken for one.

use frikan_tests::command::run;
use frikan_tests::concealed::{Case, Hidden, joint_of};
use frikan_trainer::diagnose::BaseKind;
use frikan_trainer::joint::Joint;
use frikan_trainer::plant::{self, CATALOGUE, NoiseKind, OUTSIDE};
use frikan_trainer::recording::parse;
use frikan_trainer::samples::spikes::without_spikes;
use rayon::prelude::*;

#[test]
fn nothing_that_a_joint_does_is_taken_for_a_glitch() {
    const SEED: u64 = 77_000_000;
    let effects: Vec<_> = CATALOGUE.iter().chain(OUTSIDE.iter()).zip(SEED..).collect();
    effects.into_par_iter().for_each(|(effect, seed)| {
        let case = Case { hidden: Hidden::Nothing, noise: NoiseKind::White, base: BaseKind::CoulombViscous, seed };
        let joint = joint_of(&case);
        for amplitude in [0.3, 3.0] {
            let Ok(recording) = plant::conceal(&joint, effect.name, amplitude, seed) else { continue };
            let recording = parse("simulated.csv", recording.to_csv().as_bytes(), &Joint::default()).unwrap();
            let (_, found) = without_spikes(&recording);
            assert_eq!(found, [], "{} of {amplitude}, seed {seed}", effect.name);
        }
    });
}

/// A single row of 100 N m was named a one-off event, three of 5 N m a contact and a fault of the gear.
#[test]
fn glitches_change_no_name() {
    let folder = tempfile::tempdir().unwrap();
    let fixtures = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../fixtures");
    let elbow = std::fs::read_to_string(fixtures.join("elbow.csv")).unwrap();
    std::fs::copy(fixtures.join("elbow.toml"), folder.path().join("elbow.toml")).unwrap();
    let column = |name: &str| elbow.lines().next().unwrap().split(',').position(|column| column == name).unwrap();
    let answer = |glitches: &[(usize, &str, f64)]| {
        let changed = |(row, line): (usize, &str)| {
            let mut fields: Vec<String> = line.split(',').map(String::from).collect();
            for (_, name, height) in glitches.iter().filter(|(at, ..)| *at + 1 == row) {
                let field = &mut fields[column(name)];
                *field = (field.parse::<f64>().unwrap() + height).to_string();
            }
            fields.join(",") + "\n"
        };
        let text: String = elbow.lines().enumerate().map(changed).collect();
        std::fs::write(folder.path().join("elbow.csv"), text).unwrap();
        let told = run(folder.path(), &["diagnose", "elbow.csv", "--joint", "elbow.toml", "--json", "-", "--quiet"]);
        let told: serde_json::Value = serde_json::from_str(&told.output).unwrap();
        let names: Vec<String> = told["findings"].as_array().unwrap().iter().map(|f| f["effect"].to_string()).collect();
        (names, told["health"].to_string())
    };
    let (names, health) = answer(&[]);
    assert!(!names.is_empty() && health == "[]", "{names:?} {health}");
    let in_a_row = [(2330, "torque_Nm", 5.0), (2331, "torque_Nm", 5.0), (2332, "torque_Nm", 5.0)];
    let cases: [(&[_], &str); 4] = [
        (&[(410, "torque_Nm", 100.0)], "one sample of the torque stands out alone, by "),
        (&[(410, "torque_Nm", 65_535.0)], "by 65535 N m at 1.64 s"),
        (&in_a_row, "3 samples of the torque"),
        (&[(900, "position_rad", 0.5)], "one sample of the position"),
    ];
    for (glitches, sentence) in cases {
        let told = answer(glitches);
        assert!(told.0 == names && told.1.contains(sentence), "{glitches:?}: {told:?}");
    }
}
