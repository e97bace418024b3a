use super::*;
use crate::compensator::{Compensator, Limits};
use crate::test_models::{coulomb_model, image_of};
use proptest::prelude::*;
use std::vec::Vec;

const DT: f32 = 1.0e-3;
const INERTIA: f32 = 0.5;
/// Angle of a count of the encoder, rad: 20 bits.
const COUNT: f32 = 6.0e-6;
/// Friction of the model, N m.
const COULOMB: f32 = 2.0;

/// A compensator with its supervisor.
pub(super) struct Joint16 {
    pub(super) compensator: Compensator<16>,
    pub(super) supervisor: Supervisor,
}

impl Joint16 {
    pub(super) fn new(compensator: Compensator<16>, settings: Supervision) -> Self {
        Self { compensator, supervisor: Supervisor::new(settings).unwrap() }
    }

    pub(super) fn step(&mut self, sample: &Sample, dt: f32) -> SupervisedCompensation {
        self.supervisor.step(&mut self.compensator, sample, dt)
    }
}

fn supervised(source: VelocitySource, monitored: bool) -> Joint16 {
    let limits = Limits::new(DEFAULT_GAIN, 10.0, 1.0e4).unwrap();
    let compensator = Compensator::new(&image_of(coulomb_model(COULOMB, &[])), limits);
    let supervision = Supervision { source, monitored, ..Supervision::new(INERTIA, COULOMB, COUNT) };
    Joint16::new(compensator, supervision)
}

fn sample(velocity: f32, position: f32, reference_velocity: Option<f32>) -> Sample {
    let measurement = Measurement { velocity, position, ..Measurement::ZERO };
    Sample { measurement, reference_velocity, loop_torque: 0.0 }
}

/// Speeds of a free joint with `share` of the model's friction, from the moment at which a push of 0.2 s ends.
fn let_go(share: f32, monitored: bool) -> Vec<f32> {
    let mut compensator = supervised(VelocitySource::Blended, monitored);
    let (mut velocity, mut position, mut speeds) = (0.0_f32, 0.0_f32, Vec::new());
    for step in 0..2000 {
        let torque = compensator.step(&sample(velocity, position, None), DT).torque;
        let push = if step < 200 { 3.0 } else { 0.0 };
        let driving = velocity + DT / INERTIA * (torque + push);
        // Dry friction takes at most all of the velocity.
        let dry = (DT / INERTIA * share * COULOMB).min(driving.abs());
        velocity = driving - dry.copysign(driving);
        position += DT * velocity;
        if step >= 200 {
            speeds.push(velocity.abs());
        }
    }
    speeds
}

#[test]
fn a_joint_that_is_let_go_is_not_driven_on() {
    for share in [0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.2] {
        let speeds = let_go(share, true);
        assert!(speeds[0] > 0.2);
        for pair in speeds.windows(2) {
            assert!(pair[1] <= pair[0], "friction {share} of the model: {} to {}", pair[0], pair[1]);
        }
        assert_eq!(speeds.last(), Some(&0.0), "friction {share} of the model");
    }
    let unwatched = let_go(0.7, false);
    assert!(unwatched.last() > unwatched.first());
}

#[test]
fn a_velocity_that_stands_still_or_a_position_that_does_ramps_the_torque_down() {
    // A velocity that is stuck while the joint stands, while it moves elsewhere, and one of the wrong sign.
    for travelled in [0.0, -0.5, 3.0] {
        let mut compensator = supervised(VelocitySource::Measured, false);
        let mut position = 0.0;
        for _ in 0..500 {
            position += 0.5 * DT;
            let answer = compensator.step(&sample(0.5, position, None), DT);
            assert_eq!(answer.status, Supervised::Compensator(Status::Active));
        }
        let (mut before, mut torques) = (compensator.supervisor.torque, Vec::new());
        assert!(before > 1.8);
        for _ in 0..1000 {
            position += travelled * DT;
            let torque = compensator.step(&sample(0.5, position, None), DT).torque;
            assert!(torque <= before && before - torque < 0.06, "{before} to {torque}");
            before = torque;
            torques.push(torque);
        }
        assert_eq!((torques[150] > 1.8, torques[999]), (true, 0.0), "{travelled} rad/s");
        // That they agree again is no reason to trust them: somebody has to say so.
        let mut go_on = |compensator: &mut Joint16| {
            position += 0.5 * DT;
            compensator.step(&sample(0.5, position, None), DT)
        };
        for _ in 0..500 {
            let answer = go_on(&mut compensator);
            assert_eq!((answer.torque, answer.status), (0.0, Supervised::Implausible));
        }
        compensator.supervisor.clear_fault();
        let answers: Vec<_> = (0..500).map(|_| go_on(&mut compensator)).collect();
        assert!(answers[499].torque > 1.8 && answers[499].status == Supervised::Compensator(Status::Active));
    }
}

#[test]
fn at_rest_the_torque_is_held_and_no_noise_switches_it() {
    let mut compensator = supervised(VelocitySource::Blended, true);
    let mut position = 0.0;
    for step in 0..1000 {
        let reference = 0.3 - 0.0003 * step as f32;
        position += reference * DT;
        let _ = compensator.step(&sample(reference, position, Some(reference)), DT);
    }
    // The observer still remembers the motion.
    for _ in 0..100 {
        let _ = compensator.step(&sample(0.0, position, Some(0.0)), DT);
    }
    let held = compensator.supervisor.torque;
    assert!(held > 0.0);
    for step in 0..1000 {
        let noise = if step % 2 == 0 { 0.015 } else { -0.015 };
        assert_eq!(compensator.step(&sample(noise, position, Some(0.0)), DT).torque, held);
    }
}

#[test]
fn a_sample_that_is_missing_takes_the_torque_away_within_the_slew_and_not_what_was_held() {
    let mut compensator = supervised(VelocitySource::Blended, true);
    compensator.compensator.set_limits(Limits::new(DEFAULT_GAIN, 10.0, 50.0).unwrap());
    let mut position = 0.0;
    let sample = |velocity, position, reference| Sample { loop_torque: 2.0, ..sample(velocity, position, reference) };
    for step in 0..1000 {
        let reference = 0.3 * (std::f32::consts::PI * 1.0e-3 * step as f32).sin();
        position += reference * DT;
        let _ = compensator.step(&sample(reference, position, Some(reference)), DT);
    }
    let at_rest = sample(0.0, position, Some(0.0));
    for _ in 0..100 {
        let _ = compensator.step(&at_rest, DT);
    }
    let held = compensator.supervisor.torque;
    let missing = compensator.step(&sample(f32::NAN, position, Some(0.0)), DT);
    assert_eq!(missing.status, Supervised::Compensator(Status::NotFinite));
    assert!(held > 0.1 && (held - missing.torque - 0.05).abs() < 1.0e-6, "{held} to {}", missing.torque);
    let _ = compensator.step(&at_rest, DT);
    assert_eq!(compensator.supervisor.torque, held);
    for period in [DT, 0.0, f32::NAN, DT, f32::INFINITY] {
        let _ = compensator.step(&sample(f32::NAN, position, Some(0.0)), period);
    }
    assert_eq!(compensator.supervisor.torque, 0.0);
}

#[test]
fn settings_that_cannot_be_kept_are_refused_by_name() {
    let good = Supervision::new(INERTIA, COULOMB, COUNT);
    assert!(Supervisor::new(good).is_ok());
    assert!(Supervisor::new(Supervision { inertia: 0.0, count: 0.0, ..good }).is_ok());
    for bad in [f32::NAN, -1.0, f32::INFINITY, 1.0e30] {
        for (settings, error) in [
            (Supervision { inertia: bad, ..good }, SupervisionError::Inertia),
            (Supervision { count: bad, ..good }, SupervisionError::Count),
            (Supervision { rest_velocity: bad, ..good }, SupervisionError::RestVelocity),
            (Supervision { observer_time: bad, ..good }, SupervisionError::ObserverTime),
            (Supervision { implausible_time: bad, ..good }, SupervisionError::ImplausibleTime),
            (Supervision { hold_time: bad, ..good }, SupervisionError::HoldTime),
            (Supervision { turn: bad, ..good }, SupervisionError::Turn),
        ] {
            assert_eq!(Supervisor::new(settings).err(), Some(error));
        }
    }
    let mut supervisor = Supervisor::new(good).unwrap();
    assert_eq!([-1.0, f32::NAN, 0.0].map(|inertia| supervisor.set_inertia(inertia).is_ok()), [false, false, true]);
    assert_eq!(Supervisor::new(Supervision::new(INERTIA, 0.0, COUNT)).err(), Some(SupervisionError::LeastFriction));
}

#[test]
fn a_velocity_of_another_scale_is_found() {
    for scale in [0.0, 0.6, 2.0, -1.0] {
        let mut compensator = supervised(VelocitySource::Blended, true);
        let mut last = Supervised::Degraded;
        for step in 0..3000 {
            let (sine, cosine) = (2.0 * DT * step as f32).sin_cos();
            let (position, reference) = (0.4 * sine, 0.8 * cosine);
            last = compensator.step(&sample(scale * reference, position, Some(reference)), DT).status;
        }
        assert_eq!(last, Supervised::Implausible, "{scale}");
    }
}

#[test]
fn the_reference_leads_through_zero_and_the_joint_in_sliding() {
    let supervision = Supervision::new(INERTIA, COULOMB, COUNT);
    let rest = supervision.rest_velocity;
    for measured in [-0.3, 0.0, 0.01, 0.3] {
        for reference in [0.0, 0.5 * rest, -rest] {
            assert_eq!(blended(&supervision, measured, reference), reference);
        }
    }
    assert_eq!(blended(&supervision, 0.27, 0.3), 0.27);
    assert_eq!(blended(&supervision, -0.27, -0.3), -0.27);
    // Stuck, or moved against its reference: what it takes to break away.
    for (measured, reference, broken_away) in [(0.0, 0.3, 2.0), (-0.3, 0.3, 2.0), (0.0, -0.3, -2.0)] {
        assert!((blended(&supervision, measured, reference) - broken_away * rest).abs() < 1.0e-6);
    }
}

#[test]
fn a_lower_limit_is_reached_within_the_slew() {
    let mut compensator = supervised(VelocitySource::Measured, false);
    for step in 0..100 {
        let _ = compensator.step(&sample(0.5, 0.5 * DT * step as f32, None), DT);
    }
    compensator.compensator.set_limits(Limits::new(DEFAULT_GAIN, 0.5, 200.0).unwrap());
    let mut before = compensator.supervisor.torque;
    for step in 100..150 {
        let torque = compensator.step(&sample(0.5, 0.5 * DT * step as f32, None), DT).torque;
        assert!((torque - before).abs() <= 1.001 * 200.0 * DT, "{before} to {torque}");
        before = torque;
    }
    assert_eq!(before, 0.5);
}

proptest! {
    /// Whatever comes in: finite, within the limit, a share from 0 to 1; and afterwards it still sees a velocity that is stuck.
    #[test]
    fn nothing_overflows_or_blinds_the_supervision(
        samples in proptest::collection::vec((any::<[u32; 4]>(), any::<bool>()), 1..60),
    ) {
        let mut compensator = supervised(VelocitySource::Blended, true);
        for (bits, is_free) in &samples {
            let [velocity, position, reference, loop_torque] = bits.map(f32::from_bits);
            let sample = Sample { loop_torque, ..sample(velocity, position, is_free.then_some(reference)) };
            let answer = compensator.step(&sample, DT);
            prop_assert!(answer.torque.is_finite() && answer.torque.abs() <= 10.0);
            prop_assert!((0.0..=1.0).contains(&answer.gain_share));
        }
        let mut last = compensator.step(&sample(0.5, 0.0, None), DT);
        for _ in 0..5000 {
            last = compensator.step(&sample(0.5, 0.0, None), DT);
        }
        prop_assert_eq!((last.torque, last.status), (0.0, Supervised::Implausible));
    }
}
