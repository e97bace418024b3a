//! Diagnoses of a body of 0.5 kg m2 whose second finding would be an error of the first.

use super::comparison::reference::Comparison;
use super::measurement::signals::Signals;
use super::run::diagnose;
use super::{Diagnosis, Options};
use crate::numerics::random::normal;
use crate::physics::EffectId;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;

/// Sample period, s.
const PERIOD_S: f64 = 0.004;

/// Position, velocity and acceleration at a time.
fn motion(t: f64) -> [f64; 3] {
    let tones = [(0.8, 1.3), (0.3, 5.7), (0.1, 14.1)];
    let sum = |of: fn(f64, f64, f64) -> f64| tones.iter().map(|(a, w)| of(*a, *w, t)).sum();
    [sum(|a, w, t| a * (w * t).sin()), sum(|a, w, t| a * w * (w * t).cos()), sum(|a, w, t| -a * w * w * (w * t).sin())]
}

/// A minute with Coulomb and viscous friction, noise (N m), a torque over position and velocity beside these, and the inertia that is given; the
/// torque is recorded late by a share of a sample.
fn diagnosed(inertia: f64, late_samples: f64, noise: f64, beside: impl Fn(f64, f64) -> f64) -> Diagnosis {
    let time: Vec<f64> = (0..15_000).map(|i| PERIOD_S * f64::from(i)).collect();
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let mut torque_at = |t: &f64| {
        let [position, velocity, acceleration] = motion(t - late_samples * PERIOD_S);
        let friction = 2.0 * (velocity / 0.01).tanh() + 1.2 * velocity;
        friction + 0.5 * acceleration + beside(position, velocity) + noise * normal(&mut random)
    };
    let torque = time.iter().map(&mut torque_at).collect();
    let position = time.iter().map(|t| motion(*t)[0]).collect();
    let rigid_body = Some(time.iter().map(|t| inertia * motion(*t)[2]).collect());
    let signals = Signals { rigid_body, ..Signals::without_gap(PERIOD_S, time, position, torque) };
    diagnose(&Comparison::from(signals), &Options::default()).unwrap()
}

fn named(diagnosis: &Diagnosis) -> Vec<EffectId> {
    diagnosis.findings.iter().map(|finding| finding.effect).collect()
}

#[test]
fn the_delay_of_the_sampling_is_none_that_a_wrong_inertia_brings_to_light() {
    let diagnosis = diagnosed(0.35, 0.45, 0.1, |_, _| 0.0);
    assert_eq!(named(&diagnosis), [EffectId::InertiaError]);
    let samples = diagnosis.sampling_delay_s / PERIOD_S;
    assert!((samples - 0.45).abs() < 0.1, "{samples}");
}

#[test]
fn what_the_formula_of_a_strong_effect_leaves_is_no_second_effect() {
    let stiffness = |velocity: f64| 3.0 * (1.0 + 0.14 * (std::f64::consts::PI * (velocity.abs() / 2.5).min(1.0)).cos());
    let diagnosis = diagnosed(0.5, 0.0, 0.3, |position, velocity| stiffness(velocity) * position);
    assert_eq!(named(&diagnosis), [EffectId::Spring]);
}
