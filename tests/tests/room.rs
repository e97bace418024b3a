//! The room of the drive: an image that a command writes is one that the drive of its target takes, and what has no room is named.

use std::path::Path;

use frikan_shared::image::decode;
use frikan_shared::pool::DRIVE_CELLS;
use frikan_tests::command::{Run, run};
use frikan_trainer::compile::profile::PROFILES;
use frikan_trainer::emulator::{Firmware, firmware_folder};
use serde_json::Value;

const ELBOW: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../fixtures/elbow.toml");

fn called(folder: &Path, arguments: &str) -> Run {
    let words: Vec<&str> = arguments.split_whitespace().collect();
    let done = run(folder, &words);
    assert!(done.status <= 1, "{arguments}: {}", done.messages);
    done
}

fn cells(folder: &Path, image: &str) -> usize {
    let shown = called(folder, &format!("show {image} --json -"));
    let shown: Value = serde_json::from_str(&shown.output).unwrap();
    shown["cells"].as_array().unwrap().len()
}

#[test]
fn the_profiles_are_those_of_the_firmware() {
    let folder = firmware_folder().unwrap().join("targets");
    let mut targets: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .chain(["host".to_owned()])
        .collect();
    targets.sort();
    let mut profiles: Vec<&str> = PROFILES.iter().map(|profile| profile.name).collect();
    profiles.sort_unstable();
    assert_eq!(profiles, targets);
    assert!(Firmware::find().is_ok());
    assert!(PROFILES.iter().all(|profile| profile.cells >= PROFILES[0].cells));
}

/// The law of a simulation whose directions differ takes two tables.
#[test]
fn a_table_is_thinned_to_the_room_of_the_drive_and_the_drive_takes_the_image() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    std::fs::copy(ELBOW, at.join("joint.toml")).unwrap();
    called(at, "simulate joint.toml --effect direction_asymmetry=2 --duration 40 --seed 3 -o simulated.csv --quiet");
    called(
        at,
        "simulate joint.toml --effect direction_asymmetry=2 --effect presliding=1 --duration 40 --seed 4 -o real.csv --quiet",
    );
    let diagnose = "diagnose real.csv --simulation simulated.csv --joint joint.toml";
    let large = called(at, &format!("{diagnose} --target host -o large.frk"));
    assert!(!large.messages.contains("thinned"), "{}", large.messages);
    assert!(cells(at, "large.frk") > DRIVE_CELLS, "{}", cells(at, "large.frk"));
    let small = called(at, &format!("{diagnose} -o small.frk"));
    assert!(small.messages.contains("The table of friction is thinned to "), "{}", small.messages);
    assert!(cells(at, "small.frk") <= DRIVE_CELLS);
    // As the firmware decodes it.
    let is_taken = |image: &str| decode::<DRIVE_CELLS>(&std::fs::read(at.join(image)).unwrap()).is_ok();
    assert!(is_taken("small.frk") && !is_taken("large.frk"));
    let refused = run(at, &["diagnose", "real.csv", "--target", "cortex-m9", "-o", "none.frk"]);
    assert_eq!(refused.status, 2);
    assert!(refused.messages.contains("cortex-m0plus"), "{}", refused.messages);
}
