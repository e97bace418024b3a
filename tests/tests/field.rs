//! What recordings of the field did to a fit: noise that hides the inertia, motions that repeat themselves, torque of the wrong
//! sign, and recordings that are only to be predicted.

use std::fmt::Write;

use frikan_tests::fixtures::folder;
use frikan_trainer::fit::outcome::{Form, Outcome, Soundness};
use frikan_trainer::fit::predict::{every_row, predict};
use frikan_trainer::fit::score::trace;
use frikan_trainer::fit::{Options, Training, fit, model};
use frikan_trainer::joint::Joint;
use frikan_trainer::kan::Random;
use frikan_trainer::recording::{self, Recording};

const RATE_HZ: f64 = 1000.0;
const INERTIA: f64 = 2e-4;

/// A small motor that accelerates to and fro, its current measured with little noise and its velocity with much.
/// `amplitudes` are those of its speed, rad/s, at 0.7, 1.17 and 2.9 Hz; `sign` is that of the current.
fn motor(amplitudes: [f64; 3], sign: f64, seed: u64) -> Recording {
    let mut random = Random::new(seed, 0);
    let mut noise = || random.normal();
    let rates = [0.7, 1.17, 2.9].map(|hz| hz * std::f64::consts::TAU);
    let mut text = String::from("time_s,position_rad,velocity_rad_s,current_A\n");
    for row in 0..8000 {
        let t = f64::from(row) / RATE_HZ;
        let sum = |f: &dyn Fn(f64, f64) -> f64| amplitudes.iter().zip(rates).map(|(a, w)| f(*a, w)).sum::<f64>();
        let position = sum(&|a, w| -a / w * (w * t).cos());
        let velocity = sum(&|a, w| a * (w * t).sin());
        let acceleration = sum(&|a, w| a * w * (w * t).cos());
        let current = INERTIA * acceleration + 0.06 * (velocity / 2.0).tanh() + 2e-4 * velocity;
        let (position, velocity) = (position + 0.02 * noise(), velocity + 0.8 * noise());
        let current = sign * (current + 0.01 * noise());
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{t:.4},{position:.5},{velocity:.5},{current:.6}");
    }
    recording::parse("motor.csv", text.as_bytes(), &Joint::default()).unwrap()
}

fn fitted(recordings: &[Recording], seed: u64) -> Outcome {
    let training = Training { restarts: Some(1), steps: Some(30), refinements: Some(1), ..Training::default() };
    fit(recordings, &[], &Joint::default(), &Options { seed, training, ..Options::default() }, &|_| ()).unwrap()
}

fn inertia(outcome: &Outcome) -> f64 {
    outcome.parameters.iter().find(|parameter| parameter.name == "inertia").map_or(0.0, |found| found.value)
}

/// At the narrowest filter noise of the acceleration takes nearly all of the inertia, and the noise seems none for its want.
#[test]
fn noise_does_not_talk_the_inertia_away_whatever_the_seed() {
    let train = motor([40.0, 25.0, 12.0], 1.0, 1);
    let test = motor([15.0, 35.0, 8.0], 1.0, 2);
    let scores: Vec<f64> = (1..=3)
        .map(|seed| {
            let outcome = fitted(std::slice::from_ref(&train), seed);
            assert!((inertia(&outcome) / INERTIA - 1.0).abs() < 0.03, "{}", inertia(&outcome));
            trace(&model::from_bytes(&outcome.image).unwrap().model, &test).unwrap().score.r2
        })
        .collect();
    println!("{scores:?}");
    assert!(scores.iter().all(|r2| *r2 > 0.97 && (r2 - scores[0]).abs() < 0.01), "{scores:?}");
}

#[test]
fn a_motion_that_repeats_itself_holds_nothing_out_and_says_so() {
    let outcome = fitted(&[motor([40.0, 0.0, 0.0], 1.0, 3)], 1);
    assert!(!outcome.held_out);
    assert!(outcome.remarks.iter().any(|remark| remark.contains("repeats itself")), "{:?}", outcome.remarks);
    assert!(fitted(&[motor([40.0, 25.0, 12.0], 1.0, 3)], 1).held_out);
}

#[test]
fn a_torque_of_the_wrong_sign_gives_no_image_unasked() {
    let outcome = fitted(&[motor([40.0, 25.0, 12.0], -1.0, 4)], 1);
    assert!(matches!(outcome.sound, Soundness::NotPhysical(_)), "{:?}", outcome.sound);
    assert!(outcome.candidates.iter().any(|candidate| candidate.form == Form::SimpleAsFitted));
}

/// One speed tells nothing of friction, but there is something to predict.
#[test]
fn a_recording_of_one_speed_or_of_a_few_rows_is_predicted() {
    let (_, image) = model::load(&folder().join("elbow.frk")).unwrap();
    for rows in [20, 4000] {
        let mut text = String::from("time_s,position_rad,torque_Nm\n");
        for row in 0..rows {
            let t = f64::from(row) * 0.004;
            let _ = writeln!(text, "{t:.4},{:.6},1.5", 0.3 * t);
        }
        let recording = recording::parse("one-speed.csv", text.as_bytes(), &Joint::default()).unwrap();
        let samples = every_row(&image.model, &recording).unwrap();
        let predicted = predict(&image.model, &samples).unwrap().total();
        assert!(predicted.len() == recording.len() && predicted.iter().all(|torque| torque.is_finite()));
    }
}

/// Ten recordings of one constant speed each, all in one direction, as a robot's own test bench makes them: whole recordings are held
/// out in turn, and the Stribeck shape comes out although the offset of the torque cannot be told from the Coulomb level.
#[test]
fn constant_speeds_in_one_direction_show_the_stribeck_shape() {
    let mut random = Random::new(6, 0);
    let mut noise = || random.normal();
    let speeds = [0.02, 0.04, 0.07, 0.1, 0.15, 0.25, 0.4, 0.6, 0.9, 1.3];
    let recordings = speeds.map(|speed: f64| {
        let mut text = String::from("time_s,position_rad,torque_Nm\n");
        for row in 0..2400 {
            let t = f64::from(row) * 0.005;
            let friction = 2.3 + (-speed / 0.1).exp() + 0.8 * speed;
            let (position, torque) = (speed * t + 1e-5 * noise(), friction + 0.08 * noise());
            let _ = writeln!(text, "{t:.4},{position:.6},{torque:.6}");
        }
        recording::parse(&format!("{speed}.csv"), text.as_bytes(), &Joint::default()).unwrap()
    });
    let outcome = fitted(&recordings, 1);
    let parameter = |name: &str| outcome.parameters.iter().find(|p| p.name == name).map_or(0.0, |p| p.value);
    assert!((parameter("stribeck_extra_torque") - 1.0).abs() < 0.05, "{:?}", outcome.parameters);
    assert!((parameter("stribeck_velocity") - 0.1).abs() < 0.01, "{:?}", outcome.parameters);
    assert!((parameter("viscous_coefficient") - 0.8).abs() < 0.05, "{:?}", outcome.parameters);
    // Coulomb level and offset together: each alone is anything.
    let level = parameter("coulomb_torque") + parameter("torque_offset");
    assert!((level - 2.3).abs() < 0.05, "{:?}", outcome.parameters);
}
