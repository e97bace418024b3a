use super::*;
use crate::friction::Warmth;
use crate::joints::{JointMeasurements, Joints};
use crate::measurement::Measurement;
use crate::test_models::{coulomb_model, image_of};
use frikan_shared::effect::{Effect, Element};
use frikan_shared::image::ImageError;
use nalgebra::SVector;
use proptest::prelude::*;
use std::vec::Vec;

const DT: f32 = 1.0e-3;

fn moving(velocity: f32) -> Measurement {
    Measurement { velocity, ..Measurement::ZERO }
}

fn limits(gain: f32, torque: f32, slew: f32) -> Limits {
    Limits::new(gain, torque, slew).unwrap()
}

fn compensator(limits: Limits) -> Compensator<16> {
    Compensator::new(&image_of(coulomb_model(10.0, &[])), limits)
}

#[test]
fn friction_is_compensated_within_the_limits_of_the_firmware() {
    let mut free = compensator(limits(1.0, 100.0, 1.0e9));
    assert!((free.step(&moving(1.0), DT).torque - 10.0).abs() < 1.0e-4);
    assert!((free.step(&moving(-1.0), DT).torque + 10.0).abs() < 1.0e-4);
    assert_eq!(free.step(&moving(0.0), DT).torque, 0.0);
    let mut half = compensator(limits(0.5, 100.0, 1.0e9));
    assert!((half.step(&moving(1.0), DT).torque - 5.0).abs() < 1.0e-4);
    let mut small = compensator(limits(1.0, 3.0, 1.0e9));
    assert_eq!(small.step(&moving(1.0), DT).torque, 3.0);
    let mut slow = compensator(limits(1.0, 100.0, 200.0));
    for step in 1..=10 {
        assert!((slow.step(&moving(1.0), DT).torque - 0.2 * step as f32).abs() < 1.0e-4);
    }
    let mut off = compensator(Limits::OFF);
    assert_eq!(off.step(&moving(1.0), DT).torque, 0.0);
}

#[test]
fn what_is_not_finite_gives_zero_torque_and_says_so() {
    let mut compensator = compensator(limits(1.0, 100.0, 1.0e9));
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        assert!(compensator.step(&moving(1.0), DT).torque > 9.0);
        let answer = compensator.step(&moving(bad), DT);
        assert_eq!((answer.torque, answer.status), (0.0, Status::NotFinite));
        let answer = compensator.step(&moving(1.0), bad);
        assert_eq!((answer.torque, answer.status), (0.0, Status::NotFinite));
    }
    let mut off = Compensator::<16>::new(b"not an image, but long enough", limits(1.0, 100.0, 1.0e9));
    let answer = off.step(&moving(1.0), DT);
    assert_eq!((answer.torque, answer.status), (0.0, Status::NoModel(ImageError::BadMagic)));
}

/// Over a sweep through zero in steps of 10 um/s, no change of torque is larger than the law's slope allows, none goes back by
/// more than the last places, and the sign is the velocity's.
#[test]
fn the_torque_goes_smoothly_through_zero() {
    let mut compensator = compensator(limits(1.0, 100.0, 1.0e9));
    let step = 1.0e-5;
    // d/dv 10 tanh(50 v) is at most 500.
    let largest = 1.01 * 500.0 * step;
    const LAST_PLACES: f32 = 3.0 * 10.0 * f32::EPSILON;
    let mut before = compensator.step(&moving(-0.1), DT).torque;
    for index in -9_999..=10_000 {
        let velocity = step * index as f32;
        let torque = compensator.step(&moving(velocity), DT).torque;
        assert!((-LAST_PLACES..=largest).contains(&(torque - before)), "{velocity}: {before} to {torque}");
        assert!(torque * velocity >= 0.0 && (velocity == 0.0) == (torque == 0.0), "{velocity}: {torque}");
        before = torque;
    }
    assert!(before > 9.99);
}

/// No step moves the torque faster than the slew limit: not a reversal, not a change of the limits, not the way back from a fault.
#[test]
fn the_slew_limit_holds_for_every_step() {
    let slew = 2000.0;
    let mut compensator = compensator(limits(1.0, 100.0, slew));
    let mut before = 0.0;
    for index in 0..200 {
        let velocity = if (index / 20) % 2 == 0 { 2.0 } else { -2.0 };
        if index == 50 {
            compensator.set_limits(limits(0.3, 100.0, slew));
        }
        let faulty = index % 33 == 32;
        let answer = compensator.step(&moving(if faulty { f32::NAN } else { velocity }), DT);
        // A fault takes the torque away at once: that is the one step that may be larger.
        assert!(
            faulty || (answer.torque - before).abs() <= 1.0001 * slew * DT,
            "{index}: {before} to {}",
            answer.torque
        );
        assert_eq!(faulty, answer.status == Status::NotFinite && answer.torque == 0.0);
        before = answer.torque;
    }
}

#[test]
fn no_image_exceeds_the_limit_of_the_firmware() {
    for (gain, limit) in [(1.0, 5.0), (3.0, 5.0), (0.0, 5.0), (1.0, 0.0), (f32::MAX, 5.0)] {
        let image = image_of(coulomb_model(1.0e3, &[]));
        let mut compensator = Compensator::<16>::new(&image, limits(gain, limit, 1.0e9));
        let torque = compensator.step(&moving(1.0), DT).torque;
        let expected = if gain > 0.0 { limit } else { 0.0 };
        assert_eq!(torque, expected, "gain {gain}, limit {limit}");
        assert_eq!(compensator.step(&moving(-1.0), DT).torque, -expected, "gain {gain}, limit {limit}");
    }
}

/// Every channel that the model reads switches compensation off; one that it does not read may be anything.
#[test]
fn only_what_the_model_reads_must_be_finite() {
    let mut model = coulomb_model(10.0, &[]);
    model.inputs.truncate(3);
    let mut compensator = Compensator::<16>::new(&image_of(model), limits(1.0, 100.0, 1.0e9));
    let nan = f32::NAN;
    let sound = moving(1.0);
    let unread = Measurement { temperature: nan, acceleration: nan, other: [nan; 4], ..sound };
    assert_eq!(compensator.step(&unread, DT).status, Status::Active);
    for faulty in [Measurement { load: nan, ..sound }, Measurement { position: nan, ..sound }] {
        let answer = compensator.step(&faulty, DT);
        assert_eq!((answer.torque, answer.status), (0.0, Status::NotFinite));
    }
    for dt in [-DT, -0.0, 0.0, 1.5] {
        let answer = compensator.step(&sound, dt);
        assert_eq!((answer.torque, answer.status), (0.0, Status::NotFinite));
    }
    assert_eq!(compensator.step(&sound, f32::from_bits(1)).status, Status::Active);
}

/// A reset forgets the slew and the memory of the effects: the same samples give the same bits again, once the joint is cold.
#[test]
fn a_reset_starts_over() {
    let motion: Vec<Measurement> = (0..50).map(|index| moving((0.3 * index as f32).sin())).collect();
    for (remembers, mut compensator) in [true, false].into_iter().zip(every_effect()) {
        let run = |compensator: &mut Compensator<16>| -> Vec<u32> {
            motion.iter().map(|measurement| compensator.step(measurement, DT).torque.to_bits()).collect()
        };
        let first = run(&mut compensator);
        assert_eq!(run(&mut compensator) != first, remembers);
        compensator.restore(&Warmth::COLD, 0.0);
        assert_eq!(run(&mut compensator), first);
    }
}

#[test]
fn a_key_and_slots_reach_the_compensator() {
    use frikan_shared::authentication::{Key, Trust};
    let key = Key::new([4; 32]);
    let image = image_of(coulomb_model(10.0, &[]));
    let limits = self::limits(1.0, 100.0, 1.0e9);
    let plain = Compensator::<16>::trusting(&image, Trust::Key(&key), limits);
    assert_eq!(plain.status(), Status::NoModel(ImageError::NotAuthentic));
    let tagged = [&image[..], &key.tag(&image)].concat();
    assert_eq!(Compensator::<16>::trusting(&tagged, Trust::Key(&key), limits).status(), Status::Active);
    let slot = [&crate::slots::slot_header(1, &tagged).unwrap()[..], &tagged].concat();
    let mut from_slots = Compensator::<16>::from_slots(&[], &slot, Trust::Key(&key), limits);
    assert!(from_slots.step(&moving(1.0), DT).torque > 9.9);
    let off = Compensator::<16>::from_slots(&[], &[], Trust::Anyone, limits);
    assert_eq!(off.status(), Status::NoModel(ImageError::NoImage));
}

/// Every joint gets the answer that it would get alone.
#[test]
fn six_joints_are_six_compensators() {
    let limits = |joint: usize| self::limits(1.0, 2.0 + joint as f32, 500.0 * (joint + 1) as f32);
    let alone = |joint: usize| -> Compensator<16> {
        Compensator::new(&image_of(coulomb_model(1.0 + joint as f32, &[])), limits(joint))
    };
    let mut singles: [_; 6] = std::array::from_fn(alone);
    let mut joints = Joints::new(std::array::from_fn::<_, 6, _>(alone));
    for index in 0..100 {
        let velocity = SVector::<f32, 6>::from_fn(|joint, _| (0.1 * (index * (joint + 1)) as f32).sin());
        let mut measurements = JointMeasurements::of_velocity(velocity);
        for channel in [&mut measurements.position, &mut measurements.load, &mut measurements.temperature] {
            *channel = SVector::from([0.0; 6]);
        }
        measurements.load[3] = if index % 10 == 9 { f32::INFINITY } else { 1.0 };
        let (torques, statuses) = joints.step(&measurements, DT);
        for (joint, single) in singles.iter_mut().enumerate() {
            let sample = Measurement { load: measurements.load[joint], ..moving(velocity[joint]) };
            let answer = single.step(&sample, DT);
            assert_eq!((torques[joint].to_bits(), statuses[joint]), (answer.torque.to_bits(), answer.status));
        }
    }
}

#[test]
fn joints_are_independent() {
    let limits = self::limits(1.0, 100.0, 1.0e9);
    let broken = Compensator::new(&[], limits);
    let mut joints = Joints::new([compensator(limits), broken, compensator(limits)]);
    let velocity = SVector::from([1.0, 1.0, f32::NAN]);
    let zero = SVector::from([0.0; 3]);
    let measurements =
        JointMeasurements { velocity, position: zero, acceleration: zero, load: zero, temperature: zero };
    let (torques, statuses) = joints.step(&measurements, DT);
    assert!((torques[0] - 10.0).abs() < 1.0e-4);
    assert_eq!((torques[1], torques[2]), (0.0, 0.0));
    assert_eq!(statuses, [Status::Active, Status::NoModel(ImageError::Truncated), Status::NotFinite]);
}

/// Every effect that a model may have, in two models.
fn every_effect() -> [Compensator<16>; 2] {
    let smoothing_velocity = 0.02;
    let first = [
        Effect::FrictionalLag { time_constant: 0.01 },
        Effect::Presliding {
            smoothing_velocity,
            elements: [(5.0, 1.0e-3), (2.0, 4.0e-3)]
                .map(|(torque, distance)| Element { torque, distance })
                .into_iter()
                .collect(),
        },
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
        Effect::Temperature { reference: 1.0, coulomb: -0.1, viscous: -0.05, decay: 0.03, smoothing_velocity },
        Effect::Load {
            mean: 0.05,
            difference: 0.01,
            quadratic: 1.0e-3,
            stribeck: 0.3,
            velocity: 0.1,
            smoothing_velocity,
        },
    ];
    let limits = self::limits(1.0, 30.0, 1.0e9);
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
                let measurement = Measurement { velocity, position, load, temperature, ..Measurement::ZERO };
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
