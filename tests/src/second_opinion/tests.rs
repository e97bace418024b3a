use super::*;
use frikan_trainer::physics::EffectId;
use std::collections::BTreeSet;

#[test]
fn names_are_known_and_differ() {
    let cases = cases();
    let names: BTreeSet<&str> = cases.iter().map(|case| case.name.as_str()).collect();
    assert_eq!(names.len(), cases.len());
    let effects = cases.iter().flat_map(|case| case.expected.iter().chain(&case.tolerated));
    assert!(effects.into_iter().all(|name| EffectId::from_name(name).is_some()));
}

#[test]
fn every_effect_has_a_case() {
    let cases = cases();
    // Joints that report no torque are not among these: `tests/command_line_servo.rs` conceals what their actuators do.
    let asked = EffectId::ALL.iter().filter(|effect| !effect.is_of_actuator());
    let without = asked.filter(|effect| !cases.iter().any(|case| case.is_meant(effect.name())));
    assert_eq!(without.map(|effect| effect.name()).collect::<Vec<_>>(), Vec::<&str>::new());
}

#[test]
fn a_seed_means_one_recording() {
    for (number, case) in cases().iter().enumerate().step_by(37) {
        let csv = |seed| case.record(seed, number).real.csv();
        assert_eq!(csv(1), csv(1), "{}", case.name);
        assert_ne!(csv(1), csv(2), "{}", case.name);
    }
}

#[test]
fn every_value_is_finite() {
    for (number, case) in cases().iter().enumerate().step_by(11) {
        let text = case.record(4, number).real.csv();
        assert!(!text.contains("NaN") && !text.contains("inf"), "{}", case.name);
    }
}
