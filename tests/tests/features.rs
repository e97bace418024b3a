//! Every cargo feature of what runs in the drive compiles for a drive: alone, none of them, and all; with a floating-point unit, without one, and where no
//! instruction reads and writes a word at once.

use frikan_trainer::emulator::{Firmware, Target};

/// Those of `frikan-runtime`, which switch on what they need of `frikan-shared`.
const RUNTIME: [&str; 13] = [
    "table",
    "integer",
    "expression",
    "network",
    "effects",
    "supervised",
    "slots",
    "embedded-storage",
    "auth",
    "signature",
    "defmt",
    "nalgebra",
    "models",
];

/// Those of `frikan-c`.
const C: [&str; 8] = ["supervised", "slots", "integer", "auth", "signature", "expression", "network", "effects"];

fn check(firmware: &Firmware, target: &Target, package: &str, features: &[&str]) {
    let alone = features.iter().map(|feature| (*feature).to_owned());
    for features in alone.chain([String::new(), features.join(",")]) {
        if let Err(error) = firmware.check(target, package, &features) {
            panic!("{package} with the features '{features}': {error}");
        }
    }
}

fn every_feature_compiles_alone(target: &str) -> (Firmware, Target) {
    let firmware = Firmware::find().unwrap();
    let target = firmware.target(target).unwrap();
    check(&firmware, &target, "frikan-runtime", &RUNTIME);
    (firmware, target)
}

#[test]
fn every_feature_compiles_alone_for_cortex_m4f() {
    let (firmware, target) = every_feature_compiles_alone("cortex-m4f");
    check(&firmware, &target, "frikan-c", &C);
}

#[test]
fn every_feature_compiles_alone_for_cortex_m0plus() {
    let (firmware, target) = every_feature_compiles_alone("cortex-m0plus");
    firmware.check(&target, "frikan-c", &C.join(",")).unwrap();
}

#[test]
fn every_feature_compiles_alone_for_riscv32imc() {
    let (firmware, target) = every_feature_compiles_alone("riscv32imc");
    firmware.check(&target, "frikan-c", &C.join(",")).unwrap();
}
