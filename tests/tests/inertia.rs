//! The inertia comes out whatever encoder, sample rate and noise, in short; all of it by `inertia-study`.

use frikan_tests::inertia::{Setting, found};

/// The corners of the study: nearly no noise of the torque behind a coarse encoder, and much behind a fine one.
#[test]
fn the_inertia_is_right_or_its_interval_says_how_far_it_may_be_off() {
    for (bits, rate_hz, noise) in [(10, 1000.0, 0.005), (10, 5000.0, 0.2), (13, 100.0, 0.02), (20, 1000.0, 0.2)] {
        let setting = Setting { bits, rate_hz, noise };
        let draws: Vec<_> = (50_000..50_003).map(|seed| found(setting, seed).unwrap()).collect();
        println!("{setting:?}: {draws:?}");
        assert!(draws.iter().filter(|draw| draw.is_right()).count() >= 2, "{setting:?}: {draws:?}");
        assert!(draws.iter().all(|draw| draw.error.abs() < 0.25), "{setting:?}: {draws:?}");
    }
}
