use super::super::adaptation_settings::AdaptationError;
use super::super::tests::Joint16;
use super::super::*;
use super::*;
use crate::compensator::{Compensator, Limits};
use crate::test_models::{coulomb_model, image_of};
use proptest::prelude::*;

const DT: f32 = 1.0e-3;
const INERTIA: f32 = 0.5;
/// Friction of the model, N m.
const COULOMB: f32 = 2.0;
/// Memory of the adaptation, s.
const MEMORY: f32 = 2.0;
/// Largest speed of the motion, rad/s, and its frequency, rad/s.
const SPEED: f32 = 1.0;
const FREQUENCY: f32 = 3.0;

fn settings() -> AdaptationSettings {
    AdaptationSettings::new([0.5, 1.3], [0.5, 0.4], MEMORY, 0.05).unwrap()
}

fn supervised(adaptation: Option<AdaptationSettings>) -> Joint16 {
    let limits = Limits::new(1.0, 10.0, 1.0e4).unwrap();
    let compensator = Compensator::new(&image_of(coulomb_model(COULOMB, &[])), limits);
    Joint16::new(compensator, Supervision { adaptation, ..Supervision::new(INERTIA, COULOMB, 6.0e-6) })
}

/// A joint that follows its reference exactly, and the loop that makes it.
struct Driven {
    time: f32,
    compensation: f32,
}

impl Driven {
    /// Moves for so many seconds with this friction.
    fn run(&mut self, compensator: &mut Joint16, seconds: f32, friction: Correction) {
        for _ in 0..(seconds / DT) as usize {
            self.time += DT;
            let (sine, cosine) = (FREQUENCY * self.time).sin_cos();
            let velocity = SPEED * cosine;
            let acting = friction.applied(COULOMB * velocity.signum(), velocity);
            let loop_torque = acting - INERTIA * SPEED * FREQUENCY * sine - self.compensation;
            let position = SPEED / FREQUENCY * sine;
            let measurement = Measurement { velocity, position, ..Measurement::ZERO };
            let sample = Sample { measurement, reference_velocity: Some(velocity), loop_torque };
            self.compensation = compensator.step(&sample, DT).torque;
        }
    }
}

/// Whether the torques agree to a tenth of the change of friction in these tests, which is 1 N m.
fn is_close(found: Correction, truth: Correction) -> bool {
    [-SPEED, -0.3, 0.3, SPEED].into_iter().all(|velocity| {
        let friction = COULOMB * velocity.signum();
        (found.applied(friction, velocity) - truth.applied(friction, velocity)).abs() < 0.1
    })
}

#[test]
fn a_friction_that_falls_is_followed_in_three_memories_and_back() {
    let mut compensator = supervised(Some(settings()));
    let mut joint = Driven { time: 0.0, compensation: 0.0 };
    joint.run(&mut compensator, 3.0 * MEMORY, Correction::NONE);
    assert!(
        is_close(compensator.supervisor.correction(), Correction::NONE),
        "{:?}",
        compensator.supervisor.correction()
    );
    // A joint that warms up by 40 %, of which a part is viscous, beside an offset.
    let warm = Correction { level: 0.6, viscous: -0.2, offset: 0.1 };
    for friction in [warm, Correction::NONE, warm] {
        joint.run(&mut compensator, 3.0 * MEMORY, friction);
        assert!(
            is_close(compensator.supervisor.correction(), friction),
            "{:?} for {friction:?}",
            compensator.supervisor.correction()
        );
    }
    compensator.compensator.reset();
    assert!(is_close(compensator.supervisor.correction(), warm));
    compensator.supervisor.forget();
    assert_eq!(compensator.supervisor.correction(), Correction::NONE);
}

#[test]
fn what_was_learnt_on_one_model_does_not_multiply_the_next() {
    let mut compensator = supervised(Some(settings()));
    let mut joint = Driven { time: 0.0, compensation: 0.0 };
    let more = Correction { level: 1.25, ..Correction::NONE };
    joint.run(&mut compensator, 3.0 * MEMORY, more);
    assert!(compensator.supervisor.correction().level > 1.15);
    compensator.compensator.replace_model(Ok(coulomb_model(1.25 * COULOMB, &[])));
    joint.run(&mut compensator, DT, more);
    assert!((compensator.supervisor.correction().level - 1.0).abs() < 0.01);
}

#[test]
fn what_lies_beyond_the_bounds_is_not_followed() {
    let mut compensator = supervised(Some(settings()));
    let mut joint = Driven { time: 0.0, compensation: 0.0 };
    for friction in
        [Correction { level: 0.1, viscous: -3.0, offset: 5.0 }, Correction { level: 9.0, viscous: 30.0, offset: -50.0 }]
    {
        joint.run(&mut compensator, 3.0 * MEMORY, friction);
        let found = compensator.supervisor.correction();
        assert!(
            (0.5..=1.3).contains(&found.level) && found.viscous.abs() <= 0.5 && found.offset.abs() <= 0.4,
            "{found:?}"
        );
    }
}

#[test]
fn nothing_is_learnt_at_rest_without_a_reference_or_from_faults() {
    let mut compensator = supervised(Some(settings()));
    let measured = |velocity, position| Measurement { velocity, position, ..Measurement::ZERO };
    let mut position = 0.0;
    for step in 0..5000 {
        // Pushed by hand, at rest, with a missing velocity, and with one that the position contradicts.
        let (velocity, moved, reference) = match step / 1250 {
            0 => (0.5, 0.5, None),
            1 => (0.0, 0.0, Some(0.0)),
            2 => (f32::NAN, 0.5, Some(0.5)),
            _ => (0.001, 0.001, Some(0.5)),
        };
        position += moved * DT;
        let sample =
            Sample { measurement: measured(velocity, position), reference_velocity: reference, loop_torque: 1.0 };
        let _ = compensator.step(&sample, DT);
        assert_eq!(compensator.supervisor.correction(), Correction::NONE, "step {step}");
    }
    // A velocity that stands still where the joint does not is believed for the time of plausibility, and no longer.
    let mut after_a_second = Correction::NONE;
    for step in 0..3000 {
        let sample = Sample { measurement: measured(0.5, position), reference_velocity: Some(0.5), loop_torque: 1.0 };
        let _ = compensator.step(&sample, DT);
        if step == 1000 {
            after_a_second = compensator.supervisor.correction();
        }
    }
    assert_eq!(compensator.supervisor.correction(), after_a_second);
}

#[test]
fn settings_out_of_range_are_refused() {
    for level in [[1.1, 1.2], [-0.1, 1.0], [0.5, 0.9], [0.5, 5.0], [f32::NAN, 1.0]] {
        assert_eq!(AdaptationSettings::new(level, [0.1, 0.1], 1.0, 0.1), Err(AdaptationError::Level));
    }
    for bounds in [[-0.1, 0.0], [0.0, f32::INFINITY], [f32::NAN, 0.0]] {
        assert_eq!(AdaptationSettings::new([0.5, 1.5], bounds, 1.0, 0.1), Err(AdaptationError::Bound));
    }
    for memory in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert_eq!(AdaptationSettings::new([0.5, 1.5], [0.1, 0.1], memory, 0.1), Err(AdaptationError::Memory));
    }
    for torque in [0.0, f32::NAN, f32::INFINITY] {
        assert_eq!(AdaptationSettings::new([0.5, 1.5], [0.1, 0.1], 1.0, torque), Err(AdaptationError::TrustedTorque));
    }
}

proptest! {
    #[test]
    fn the_solution_solves(rows in prop::array::uniform4(prop::array::uniform3(-3.0f32..3.0)), truth in prop::array::uniform3(-1.0f32..1.0)) {
        let sum = |i: usize, j: usize| rows.iter().map(|row| row[i] * row[j]).sum::<f32>();
        let full = [[sum(0, 0), sum(0, 1), sum(0, 2)], [sum(0, 1), sum(1, 1), sum(1, 2)], [sum(0, 2), sum(1, 2), sum(2, 2)]];
        let prior = 0.5;
        let right = [0, 1, 2].map(|i| (0..3).map(|j| full[i][j] * truth[j]).sum::<f32>() + prior * truth[i]);
        let found = solved([full[0][0], full[0][1], full[0][2], full[1][1], full[1][2], full[2][2]], right, prior);
        for (found, truth) in found.iter().zip(truth) {
            prop_assert!((found - truth).abs() < 1e-3, "{found} for {truth}");
        }
    }

    #[test]
    fn no_sequence_of_samples_leads_beyond_the_bounds(bits in prop::collection::vec((any::<u32>(), any::<u32>(), any::<u32>(), any::<u32>()), 1..200)) {
        let mut compensator = supervised(Some(settings()));
        for (velocity, position, reference, torque) in bits {
            let [velocity, position, reference, loop_torque] = [velocity, position, reference, torque].map(f32::from_bits);
            let measurement = Measurement { velocity, position, ..Measurement::ZERO };
            let sample = Sample { measurement, reference_velocity: Some(reference), loop_torque };
            let answer = compensator.step(&sample, DT);
            let found = compensator.supervisor.correction();
            prop_assert!(answer.torque.is_finite() && answer.torque.abs() <= 10.0);
            prop_assert!((0.5..=1.3).contains(&found.level) && found.viscous.abs() <= 0.5 && found.offset.abs() <= 0.4);
        }
    }
}

#[test]
fn what_was_learnt_survives_a_loss_of_power_and_damage_does_no_harm() {
    let truth = Correction { level: 0.7, viscous: 0.1, offset: 0.2 };
    let (mut joint, mut driven) = (supervised(Some(settings())), Driven { time: 0.0, compensation: 0.0 });
    driven.run(&mut joint, 5.0 * MEMORY, truth);
    let learnt = joint.supervisor.learnt();
    let mut again = supervised(Some(settings()));
    again.supervisor.restore(&learnt);
    assert_eq!(again.supervisor.correction(), joint.supervisor.correction());
    Driven { time: 0.0, compensation: 0.0 }.run(&mut again, 0.5, truth);
    assert!(is_close(again.supervisor.correction(), truth), "{:?}", again.supervisor.correction());
    // Without an adaptation there is nothing to restore.
    let mut fixed = supervised(None);
    fixed.supervisor.restore(&learnt);
    assert_eq!(fixed.supervisor.correction(), Correction::NONE);
    for place in 0..9 {
        for bad in [f32::NAN, f32::INFINITY, 1.0e30, -1.0e3] {
            let mut damaged = learnt;
            damaged.means[place] = bad;
            again.supervisor.restore(&damaged);
            let Correction { level, viscous, offset } = again.supervisor.correction();
            assert!((0.5..=1.3).contains(&level) && viscous.abs() <= 0.5 && offset.abs() <= 0.4, "{place} {bad}");
        }
    }
}
