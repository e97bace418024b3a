//! The constants of a known joint come out with their form, in short; all of it by `law-coverage`.

use frikan_tests::law_coverage::{Setting, Truth, printed};

#[test]
fn the_elbow_has_the_stribeck_friction_that_it_was_given() {
    for seed in [80_100, 80_101] {
        let found = printed(Setting { truth: Truth::Exponential, rate_hz: 250.0, bits: 21 }, seed).unwrap();
        assert!(found.is_right, "{}", found.law);
        let stribeck = found.constants.iter().find(|constant| constant.name == "stribeck_extra_torque").unwrap();
        assert!((stribeck.value - 1.0).abs() < 0.05, "{stribeck:?}");
        // Of eight intervals of 95 % one or two may miss.
        assert!(found.constants.iter().filter(|constant| !constant.is_held()).count() <= 2, "{:?}", found.constants);
    }
}
