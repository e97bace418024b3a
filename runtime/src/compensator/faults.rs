//! What a firmware may get wrong, one test each.

use super::*;
use crate::friction::Warmth;
use crate::measurement::Measurement;
use crate::test_models::{TestModel, coulomb_model, image_of};
use frikan_shared::effect::Effect;
use frikan_shared::expression::{Operation, Program};
use frikan_shared::model::Law;

const DT: f32 = 1.0e-3;

fn compensator(model: TestModel, limits: Limits) -> Compensator<16> {
    Compensator::new(&image_of(model), limits)
}

fn wide() -> Limits {
    Limits::new(1.0, 100.0, 1.0e9).unwrap()
}

fn moving(velocity: f32) -> Measurement {
    Measurement { velocity, ..Measurement::ZERO }
}

#[test]
fn limits_that_cannot_be_kept_are_refused_by_name() {
    for bad in [f32::NAN, -1.0, f32::INFINITY, f32::NEG_INFINITY] {
        assert_eq!(Limits::new(bad, 1.0, 1.0), Err(LimitError::Gain));
        assert_eq!(Limits::new(1.0, bad, 1.0), Err(LimitError::Torque));
        assert_eq!(Limits::new(1.0, 1.0, bad), Err(LimitError::Slew));
        assert_eq!(wide().with_position(bad), Err(LimitError::Position));
    }
    assert_eq!(Limits::new(1.0, 1.0, 0.0), Err(LimitError::Slew));
    // The sign of a zero is no sign: bits that are compared as magnitudes must not hold one.
    let mut off = compensator(coulomb_model(10.0, &[]), Limits::new(-0.0, -0.0, 1.0).unwrap());
    assert_eq!(off.step(&moving(1.0), DT).torque, 0.0);
}

#[test]
fn the_largest_numbers_that_are_limits_leave_the_torque_finite() {
    let mut compensator = compensator(coulomb_model(10.0, &[]), Limits::new(f32::MAX, f32::MAX, f32::MAX).unwrap());
    for velocity in [1.0, -1.0, 1.0, -1.0] {
        let torque = compensator.step(&moving(velocity), 1.0).torque;
        assert!(torque.is_finite() && torque * velocity > 0.0, "{torque}");
    }
}

#[test]
fn a_lower_torque_limit_is_reached_no_faster_than_the_slew_limit() {
    let slew = 1000.0;
    let mut compensator = compensator(coulomb_model(20.0, &[]), Limits::new(1.0, 19.8, slew).unwrap());
    for _ in 0..100 {
        let _ = compensator.step(&moving(1.0), DT);
    }
    compensator.set_limits(Limits::new(1.0, 5.0, slew).unwrap());
    let mut before = 19.8;
    for step in 0..20 {
        let torque = compensator.step(&moving(1.0), DT).torque;
        assert!((torque - before).abs() <= 1.0001 * slew * DT, "{step}: {before} to {torque}");
        before = torque;
    }
    assert_eq!(before, 5.0);
}

#[test]
fn a_channel_that_nobody_fills_is_missing_and_not_zero() {
    let mut compensator = compensator(coulomb_model(10.0, &[]), wide());
    let filled = [
        Measurement { velocity: 1.0, ..Measurement::default() },
        Measurement { velocity: 1.0, position: 0.0, load: 0.0, ..Measurement::default() },
    ];
    for measurement in filled {
        let answer = compensator.step(&measurement, DT);
        assert_eq!((answer.torque, answer.status), (0.0, Status::NotFinite));
    }
    let read = Measurement { velocity: 1.0, position: 0.0, load: 0.0, temperature: 20.0, ..Measurement::default() };
    assert_eq!(compensator.step(&read, DT).status, Status::Active);
}

/// Adds `offset` to `10 tanh(50 v)`, as a law does whose sides do not meet at rest.
fn offset_model(offset: f32) -> TestModel {
    let mut model = coulomb_model(10.0, &[]);
    let operations =
        [Operation::ScaledInput(0, 50.0), Operation::Tanh, Operation::Scale(10.0), Operation::Offset(offset)];
    model.law = Law::Expression(Program { operations: heapless::Vec::from_slice(&operations).unwrap() });
    model
}

#[test]
fn no_static_law_pushes_a_joint_at_rest() {
    let mut compensator = compensator(offset_model(-0.54), wide());
    for rest in [0.0, -0.0] {
        let answer = compensator.step(&moving(rest), DT);
        assert_eq!((answer.torque, answer.status), (0.0, Status::Active));
    }
    assert!((compensator.step(&moving(1.0e-6), DT).torque + 0.54).abs() < 1.0e-2);
}

#[test]
fn the_position_put_out_is_bounded_by_the_firmware() {
    let play = [Effect::Play { half_width: 0.5, torque: 0.0 }];
    for limit in [0.0, 0.01, 10.0] {
        let mut compensator = compensator(coulomb_model(10.0, &play), wide().with_position(limit).unwrap());
        let _ = compensator.step(&moving(0.0), DT);
        let answer = compensator.step(&Measurement { position: 1.5, ..moving(1.0) }, DT);
        assert_eq!(answer.position.abs(), limit.min(0.5));
    }
    let mut default = compensator(coulomb_model(10.0, &play), wide());
    let _ = default.step(&moving(0.0), DT);
    assert_eq!(default.step(&Measurement { position: 1.5, ..moving(1.0) }, DT).position, 0.0);
}

fn warm_up(limits: Limits) -> Compensator<16> {
    let warm_up = Effect::WarmUp {
        time_constant: 600.0,
        coulomb: -0.4,
        viscous: 0.0,
        power_limit: 10.0,
        smoothing_velocity: 0.02,
    };
    compensator(coulomb_model(10.0, &[warm_up]), limits)
}

#[test]
fn warmth_survives_a_reset_and_a_loss_of_power() {
    let mut warm = warm_up(wide());
    let cold = warm.step(&moving(1.0), DT).torque;
    for _ in 0..3000 {
        let _ = warm.step(&moving(1.0), 1.0);
    }
    let hot = warm.step(&moving(1.0), DT).torque;
    assert!(hot < 0.7 * cold, "{cold} to {hot}");
    let saved = warm.warmth();
    warm.reset();
    assert!((warm.step(&moving(1.0), DT).torque - hot).abs() < 1.0e-3);
    let after = |warmth: &Warmth, rest: f32| {
        let mut drive = warm_up(wide());
        drive.restore(warmth, rest);
        drive.step(&moving(1.0), DT).torque
    };
    assert!((after(&saved, 0.0) - hot).abs() < 1.0e-3);
    assert!((after(&saved, f32::NAN) - hot).abs() < 1.0e-3);
    // One time constant of rest leaves 37 % of the warmth.
    let left = (cold - after(&saved, 600.0)) / (cold - hot);
    assert!((left - 0.368).abs() < 0.01, "{left}");
    assert!((after(&saved, f32::INFINITY) - cold).abs() < 1.0e-3);
    // Damaged memory is held to what the model allows.
    for (power, expected) in [(f32::NAN, cold), (-5.0, cold), (f32::INFINITY, cold - 4.0), (1.0e30, cold - 4.0)] {
        assert!((after(&Warmth { power: [power; 8] }, 0.0) - expected).abs() < 1.0e-2, "{power}");
    }
}
