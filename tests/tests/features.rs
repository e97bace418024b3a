//! Every cargo feature of what runs in the drive compiles for a drive: alone, none of them, and all.

use frikan_trainer::emulator::{Firmware, Target};

fn check(firmware: &Firmware, target: &Target, package: &str, features: &[&str]) {
    let alone = features.iter().map(|feature| (*feature).to_owned());
    for features in alone.chain([String::new(), features.join(",")]) {
        if let Err(error) = firmware.check(target, package, &features) {
            panic!("{package} with the features '{features}': {error}");
        }
    }
}

#[test]
fn every_feature_compiles_alone() {
    let firmware = Firmware::find().unwrap();
    let target = firmware.target("cortex-m4f").unwrap();
    let runtime = [
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
    check(&firmware, &target, "frikan-shared", &["models", "elementary", "auth", "signature", "defmt"]);
    check(&firmware, &target, "frikan-runtime", &runtime);
    check(
        &firmware,
        &target,
        "frikan-c",
        &["supervised", "slots", "integer", "auth", "expression", "network", "effects"],
    );
}

/// Without a floating-point unit, and without atomic instructions that read and write.
#[test]
fn the_smallest_and_the_largest_compile_for_the_smallest_drive() {
    let firmware = Firmware::find().unwrap();
    let target = firmware.target("cortex-m0plus").unwrap();
    firmware.check(&target, "frikan-runtime", "table").unwrap();
    firmware.check(&target, "frikan-c", "supervised,slots,integer,auth,expression,network,effects").unwrap();
}
