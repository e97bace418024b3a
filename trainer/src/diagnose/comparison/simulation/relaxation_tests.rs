//! Simulations whose friction turns over before the velocity, with it and after it.

use super::{learn, learn_static};
use crate::diagnose::comparison::reference::Comparison;
use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::rows::Lock;
use crate::numerics::least_squares::least_squares;

/// 0.4 kg m2 with Coulomb friction of 2 N m that turns over `ahead` seconds before the velocity, logged every 4 ms.
fn moving(ahead: f64) -> Signals {
    moving_softly(ahead, 0.001)
}

/// The same with friction that turns over within a width (rad/s).
fn moving_softly(ahead: f64, width: f64) -> Signals {
    let time: Vec<f64> = (0..10_000).map(|i| 0.004 * f64::from(i)).collect();
    let swing = |t: f64| [(0.8, 1.3), (0.3, 4.1), (0.08, 10.7)].map(|(a, w): (f64, f64)| (a, w, w * t));
    let sum = |t: f64, f: fn((f64, f64, f64)) -> f64| -> f64 { swing(t).into_iter().map(f).sum() };
    let velocity = |t: f64| sum(t, |(a, w, x)| a * w * x.cos());
    let acceleration = |t: f64| sum(t, |(a, w, x)| -a * w * w * x.sin());
    let dry = |t: f64| 2.0 * ((velocity(t) + ahead * acceleration(t)) / width).tanh();
    let torque = time.iter().map(|t| 0.4 * acceleration(*t) + dry(*t) + 0.5 * velocity(*t)).collect();
    let position = time.iter().map(|t| sum(*t, |(a, _, x)| a * x.sin())).collect();
    Signals::without_gap(0.004, time, position, torque)
}

#[test]
fn the_relaxation_of_a_soft_constraint_is_found_and_stays_out_of_the_law() {
    for ahead in [0.003, 0.0095, 0.03] {
        let law = learn(&moving(ahead), &moving(0.0), &|_| Vec::new()).unwrap();
        let found = law.relaxation_s.unwrap();
        assert!((found / ahead - 1.0).abs() < 0.2, "{found} for {ahead}");
        for speed in [0.001, 0.01, 0.05, 0.2] {
            let friction = law.friction(speed) - 0.5 * speed;
            assert!((friction - 2.0 * (speed / law.sign_velocity).tanh()).abs() < 0.25, "{friction} at {speed}");
        }
    }
}

/// A simulator that steps in 1 ms and a joint that it computed in 0.25 ms differ by 0.375 ms.
#[test]
fn a_step_of_the_simulator_shifts_where_friction_turns_over() {
    let (simulation, real) = (moving_softly(0.0095, 0.02), moving_softly(0.0095 + 0.000_375, 0.02));
    let law = learn(&simulation, &real, &|_| Vec::new()).unwrap();
    let reference = law.at(&real.states());
    let [residual, rate] = &reference.replayed[..] else { panic!("{} series", reference.replayed.len()) };
    let left = real.states().map(|i| real.torque[i] - reference.torque[i]);
    let prepared = Comparison::from(real).prepare(Lock::Nothing);
    let shifted = [residual, rate].map(|series| prepared.filtered(series));
    let found = least_squares(&shifted, &prepared.filtered(&left), &prepared.open_runs()).unwrap();
    assert!((found[0] - 1.0).abs() < 0.05 && (found[1] / 0.000_375 - 1.0).abs() < 0.2, "{found:?}");
}

#[test]
fn friction_that_turns_over_with_the_velocity_or_after_it_has_none() {
    for ahead in [0.0, -0.0095] {
        assert_eq!(learn(&moving(ahead), &moving(0.0), &|_| Vec::new()).unwrap().relaxation_s, None, "{ahead}");
    }
}

#[test]
fn a_static_law_turns_over_as_early_as_its_simulation() {
    for ahead in [0.003, 0.0095, 0.03] {
        let law = learn_static(&moving(ahead), &moving(0.0)).unwrap();
        assert!((law.lead_s / ahead - 1.0).abs() < 0.2, "{} for {ahead}", law.lead_s);
    }
    for ahead in [0.0, -0.0095] {
        let law = learn_static(&moving(ahead), &moving(0.0)).unwrap();
        assert!(law.lead_s < 0.001, "{} for {ahead}", law.lead_s);
    }
}

#[test]
fn a_static_law_turns_over_as_softly_as_its_simulation() {
    for width in [0.05, 0.15] {
        let law = learn_static(&moving_softly(0.0095, width), &moving(0.0)).unwrap();
        assert!((law.sign_velocity / width - 1.0).abs() < 0.2, "{} for {width}", law.sign_velocity);
        assert!((law.lead_s / 0.0095 - 1.0).abs() < 0.2, "{} at a width of {width}", law.lead_s);
    }
}
