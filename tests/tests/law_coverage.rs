//! The constants of a known joint come out with their form, in short; all of it by `interval-coverage law`.

use frikan_tests::coverage::law::{Setting, Truth, printed};

/// In one of fifteen recordings the formula of one of the held-out turns leaves all bounds, and Coulomb and viscous friction is taken.
#[test]
fn the_elbow_has_the_stribeck_friction_that_it_was_given() {
    let setting = Setting { truth: Truth::Exponential, rate_hz: 250.0, bits: 21 };
    let found = [80_100, 80_101, 80_102].map(|seed| printed(setting, seed).unwrap());
    let right: Vec<_> = found.iter().filter(|found| found.is_right).collect();
    assert!(right.len() >= 2, "{:?}", found.map(|found| found.law));
    for found in right {
        let stribeck = found.constants.iter().find(|constant| constant.name == "stribeck_extra_torque").unwrap();
        assert!((stribeck.value - 1.0).abs() < 0.05, "{stribeck:?}");
        // Of eight intervals of 95 % one or two may miss.
        assert!(found.constants.iter().filter(|constant| !constant.is_held()).count() <= 2, "{:?}", found.constants);
    }
}

/// What a coarser encoder makes of the acceleration takes some of the inertia, and a delay that does not show stays in: the intervals of the body
/// allow for both. Those of its friction are still too narrow there.
#[test]
fn the_body_behind_a_coarser_encoder_is_held_by_its_intervals() {
    for rate_hz in [250.0, 1000.0] {
        let setting = Setting { truth: Truth::Exponential, rate_hz, bits: 16 };
        let found = [81_000, 81_001, 81_002].map(|seed| printed(setting, seed).unwrap());
        let of_body = |name: &str| ["inertia", "gravity_sine", "gravity_cosine", "torque_offset"].contains(&name);
        let constants = found.iter().flat_map(|found| &found.constants).filter(|constant| of_body(&constant.name));
        let missed: Vec<_> = constants.filter(|constant| !constant.is_held()).collect();
        assert!(missed.len() <= 1, "{rate_hz} Hz: {missed:?}");
    }
}
