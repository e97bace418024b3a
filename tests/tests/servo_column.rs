//! An effect hidden in a joint that records no torque is named as one beside a torque column is, and the noise of its position is not named.

use frikan_tests::concealed::servo::{Source, draw, effects};
use frikan_trainer::actuator::Kind;

#[test]
fn an_effect_is_named_in_the_torque_that_an_actuator_makes_of_its_commands() {
    assert!(effects().any(|effect| effect == "stribeck") && effects().all(|effect| effect != "torque_offset"));
    let told = draw(Some("stribeck"), 880_000_000, &[Source::Command(Kind::Current)]).remove(0).unwrap();
    assert!((told.lambda / 80.0 - 1.0).abs() < 0.25, "{told:?}");
    assert!(told.is_first() && !told.has_wrong_name(), "{told:?}");
}

#[test]
fn noise_of_the_position_of_a_healthy_joint_gets_no_name() {
    let sources = [Source::Position(Kind::Pd), Source::Position(Kind::PositionServo)];
    let told: Vec<_> = [880_000_004, 880_000_005].into_iter().flat_map(|seed| draw(None, seed, &sources)).collect();
    let named = told.iter().filter(|told| !told.as_ref().unwrap().findings.is_empty());
    // All of them were told of elasticity or windup, which was the noise.
    assert!(named.count() <= 1, "{told:?}");
}
