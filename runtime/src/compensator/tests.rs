use super::*;
use crate::joints::{JointMeasurements, Joints};
use crate::test_models::{coulomb_model, image_of};
use frikan_shared::effect::Effect;
use nalgebra::SVector;
use proptest::prelude::*;

const DT: f32 = 1.0e-3;

fn moving(velocity: f32) -> Measurement {
    Measurement { velocity, ..Measurement::default() }
}

fn compensator(limits: Limits) -> Compensator<16> {
    Compensator::new(&image_of(coulomb_model(10.0, &[])), limits)
}

#[test]
fn friction_is_compensated_within_the_limits_of_the_firmware() {
    let mut free = compensator(Limits::new(1.0, 100.0, 1.0e9));
    assert!((free.step(&moving(1.0), DT).torque - 10.0).abs() < 1.0e-4);
    assert!((free.step(&moving(-1.0), DT).torque + 10.0).abs() < 1.0e-4);
    assert_eq!(free.step(&moving(0.0), DT).torque, 0.0);
    let mut half = compensator(Limits::new(0.5, 100.0, 1.0e9));
    assert!((half.step(&moving(1.0), DT).torque - 5.0).abs() < 1.0e-4);
    let mut small = compensator(Limits::new(1.0, 3.0, 1.0e9));
    assert_eq!(small.step(&moving(1.0), DT).torque, 3.0);
    let mut slow = compensator(Limits::new(1.0, 100.0, 200.0));
    for step in 1..=10 {
        assert!((slow.step(&moving(1.0), DT).torque - 0.2 * step as f32).abs() < 1.0e-4);
    }
    let mut off = compensator(Limits::new(f32::NAN, 100.0, 200.0));
    assert_eq!(off.step(&moving(1.0), DT).torque, 0.0);
}

#[test]
fn what_is_not_finite_gives_zero_torque_and_says_so() {
    let mut compensator = compensator(Limits::new(1.0, 100.0, 1.0e9));
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert!(compensator.step(&moving(1.0), DT).torque > 9.0);
        let answer = compensator.step(&moving(bad), DT);
        assert_eq!((answer.torque, answer.status), (0.0, Status::NotFinite));
        let answer = compensator.step(&moving(1.0), bad);
        assert_eq!((answer.torque, answer.status), (0.0, Status::NotFinite));
    }
    let mut off = Compensator::<16>::new(b"not an image, but long enough", Limits::new(1.0, 100.0, 1.0e9));
    let answer = off.step(&moving(1.0), DT);
    assert_eq!((answer.torque, answer.status), (0.0, Status::NoModel(ImageError::BadMagic)));
}

#[test]
fn joints_are_independent() {
    let limits = Limits::new(1.0, 100.0, 1.0e9);
    let broken = Compensator::new(&[], limits);
    let mut joints = Joints::new([compensator(limits), broken, compensator(limits)]);
    let velocity = SVector::from([1.0, 1.0, f32::NAN]);
    let (torques, statuses) = joints.step(&JointMeasurements::of_velocity(velocity), DT);
    assert!((torques[0] - 10.0).abs() < 1.0e-4);
    assert_eq!((torques[1], torques[2]), (0.0, 0.0));
    assert_eq!(statuses, [Status::Active, Status::NoModel(ImageError::Truncated), Status::NotFinite]);
}

/// Every effect that a model may have, in two models.
fn every_effect() -> [Compensator<16>; 2] {
    let smoothing_velocity = 0.02;
    let first = [
        Effect::FrictionalLag { time_constant: 0.01 },
        Effect::Presliding { coulomb: 5.0, breakaway: 7.0, velocity: 0.1, stiffness: 5.0e3, smoothing_velocity },
        Effect::DwellBreakaway {
            gain: 1.0,
            time: 0.1,
            distance: 1.0e-2,
            rest_velocity: 1.0e-3,
            dwell_limit: 100.0,
            smoothing_velocity,
        },
        Effect::WarmUp { time_constant: 600.0, coulomb: -0.1, viscous: 0.1, power_limit: 20.0, smoothing_velocity },
        Effect::Play { half_width: 1.0e-2, torque: 1.0 },
        Effect::WindupHysteresis { torque: 2.0, distance: 0.1 },
        Effect::Spring { stiffness: 1.0, rest: 0.1 },
        Effect::Asymmetry { coulomb: 0.5, viscous: 0.1, smoothing_velocity },
    ];
    let second = [
        Effect::Coulomb { coulomb: 0.5, viscous: 0.1, smoothing_velocity },
        Effect::Stribeck { amplitude: 2.0, velocity: 0.1, exponent: 0.5, smoothing_velocity },
        Effect::PowerViscous { coefficient: 1.0, exponent: 0.7, smoothing_velocity },
        Effect::Temperature { reference: 1.0, coulomb: -0.1, viscous: -0.05, smoothing_velocity },
        Effect::Load {
            mean: 0.05,
            difference: 0.01,
            quadratic: 1.0e-3,
            stribeck: 0.3,
            velocity: 0.1,
            smoothing_velocity,
        },
    ];
    let limits = Limits::new(1.0, 30.0, 1.0e9);
    [&first[..], &second[..]].map(|effects| Compensator::new(&image_of(coulomb_model(10.0, effects)), limits))
}

proptest! {
    /// Whatever comes in, any bit pattern included: finite, within the limit, and the state stays usable.
    #[test]
    fn every_answer_is_finite_and_within_the_limit(
        samples in proptest::collection::vec((any::<[u32; 4]>(), any::<u32>(), any::<bool>()), 1..60),
    ) {
        for mut compensator in every_effect() {
            for (bits, dt, wild) in &samples {
                let [velocity, position, load, temperature] = bits.map(f32::from_bits);
                let measurement = Measurement { velocity, position, load, temperature, ..Measurement::default() };
                let answer = compensator.step(&measurement, if *wild { f32::from_bits(*dt) } else { DT });
                prop_assert!(answer.torque.is_finite() && answer.torque.abs() <= 30.0);
                prop_assert!(answer.position.is_finite());
                let calm = compensator.step(&moving(0.5), DT);
                prop_assert_eq!(calm.status, Status::Active);
                prop_assert!(calm.torque.is_finite() && calm.torque.abs() <= 30.0);
            }
        }
    }
}
