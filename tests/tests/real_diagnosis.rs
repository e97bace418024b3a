//! What the diagnosis makes of other people's recordings, read from `../shared/recordings`, where more is known than they show.

use std::f64::consts::TAU;

use frikan_runtime::shared::model::RigidBody;
use frikan_runtime::shared::units::Unit;
use frikan_tests::concealed::semi_real::{Real, listed};
use frikan_tests::recordings;
use frikan_trainer::compile::improved::{Origin, improve};
use frikan_trainer::compile::profile::Profile;
use frikan_trainer::diagnose::{Diagnosis, Lock, Options, Signals, diagnose};
use frikan_trainer::fit::score::trace;
use frikan_trainer::joint::Joint;
use frikan_trainer::physics::EffectId;
use frikan_trainer::recording::{self, Recording};
use frikan_trainer::samples::relevance::correlation;

fn load(name: &str, joint: &Joint) -> Option<Recording> {
    Some(recording::load(&recordings()?.join(name), joint).unwrap_or_else(|error| panic!("{error}")))
}

fn diagnosed(recording: &Recording, joint: &Joint, lock: Lock) -> (Signals, Diagnosis) {
    let signals = Signals::of(recording, joint).unwrap();
    let diagnosis = diagnose(&signals.clone().into(), &Options { lock, ..Options::default() }).unwrap();
    (signals, diagnosis)
}

fn named(diagnosis: &Diagnosis) -> Vec<EffectId> {
    diagnosis.findings.iter().map(|finding| finding.effect).collect()
}

/// Share of the variance of the torque on locked rows that is left to explain no more.
fn locked_r2(diagnosis: &Diagnosis) -> [f64; 2] {
    let traces = &diagnosis.traces;
    let locked: Vec<usize> = (0..traces.len()).filter(|&i| traces.locked[i]).collect();
    let mean = locked.iter().map(|&i| traces.torque[i]).sum::<f64>() / locked.len() as f64;
    let spread: f64 = locked.iter().map(|&i| (traces.torque[i] - mean).powi(2)).sum();
    let r2 = |rest: &[f64]| 1.0 - locked.iter().map(|&i| rest[i] * rest[i]).sum::<f64>() / spread;
    [r2(&traces.before), r2(&traces.after)]
}

/// Janot, Gautier and Brunot (2019): 3.11 % asymmetric on the training run, 5.98 % on the pulses.
#[test]
fn the_emps_axis_differs_between_its_directions() {
    let joint = Joint::default();
    let Some(train) = load("emps/train.csv", &joint) else { return };
    let pulses = load("emps/pulses.csv", &joint).unwrap();
    let (signals, diagnosis) = diagnosed(&train, &joint, Lock::Spread);
    let names = named(&diagnosis);
    let expected = [EffectId::DirectionAsymmetry, EffectId::TorqueOffset];
    assert!(!names.is_empty() && names.iter().all(|name| expected.contains(name)), "{names:?}");
    let image = improve(
        &diagnosis,
        &signals.clone().into(),
        Origin::Recording(RigidBody::default()),
        Unit::Newton,
        Profile::default(),
    )
    .unwrap()
    .model;
    let error = |recording| trace(&image, recording).unwrap().filtered_score.relative_error;
    let (on_train, on_pulses) = (error(&train), error(&pulses));
    println!("{names:?}: {:.2} % train, {:.2} % pulses", 100.0 * on_train, 100.0 * on_pulses);
    assert!(on_train <= 0.032 && on_pulses <= 0.055);
}

/// The firmware's own cogging map was measured apart from the recording, by standing still at every count.
#[test]
fn the_bare_motor_cogs_as_its_map_says() {
    const COUNTS: usize = 8192;
    let joint = Joint::parse(&format!("[drive]\ncounts_per_turn = {COUNTS}")).unwrap();
    let Some(motor) = load("odrive_cogging/slow2-nocomp_0.csv", &joint) else { return };
    let (_, diagnosis) = diagnosed(&motor, &joint, Lock::Tail(0.5));
    let [before, after] = locked_r2(&diagnosis);
    let ripples: Vec<(f64, f64, f64)> = diagnosis
        .findings
        .iter()
        .filter(|finding| finding.effect == EffectId::PositionRipple)
        .map(|f| (f.fitted.shape[0], f.fitted.coefficients[0], f.fitted.coefficients[1]))
        .collect();
    let at = |count: usize| -> f64 {
        let angle = TAU * count as f64 / COUNTS as f64;
        ripples.iter().map(|(order, cosine, sine)| cosine * (order * angle).cos() + sine * (order * angle).sin()).sum()
    };
    let map = std::fs::read_to_string(recordings().unwrap().join("odrive_cogging/measured_cogging_map.csv"));
    let map: Vec<f64> =
        map.unwrap().lines().skip(1).map(|line| line.split(',').nth(1).unwrap().parse().unwrap()).collect();
    let found: Vec<f64> = (0..map.len()).map(at).collect();
    let agreement = correlation(&found, &map);
    let orders: Vec<f64> = ripples.iter().map(|(order, ..)| *order).collect();
    println!(
        "orders {orders:.1?}, R2 {before:.3} -> {after:.3} on the later half, correlation with the map {agreement:.3}"
    );
    assert_eq!(diagnosis.findings[0].effect, EffectId::PositionRipple);
    // Seven pole pairs.
    assert!((ripples[0].0 - 7.0).abs() < 0.1);
    assert!(before < 0.13 && after > 0.92);
    assert!(agreement > 0.84);
}

/// A structure without a name that holds cogging and spring together does not fit the later half: what it took up is looked for again without
/// it, and nothing is not the answer.
#[test]
fn a_spring_beside_the_cogging_of_the_bare_motor_does_not_hide_it() {
    let joint = Joint::parse("[drive]\ncounts_per_turn = 8192").unwrap();
    let Some(motor) = load("odrive_cogging/slow_goodgains_2-comp_2.csv", &joint) else { return };
    let mut signals = Signals::of(&motor, &joint).unwrap();
    // A tenth of the recorded current beside friction, root mean square.
    const STIFFNESS_A_RAD: f64 = 0.0403;
    let lowest = signals.position.iter().copied().fold(f64::INFINITY, f64::min);
    let span = signals.position.iter().copied().fold(f64::NEG_INFINITY, f64::max) - lowest;
    let spring = |q: &f64| STIFFNESS_A_RAD * (q - lowest - 0.37 * span);
    let torque = signals.torque.iter().zip(&signals.position).map(|(torque, q)| torque + spring(q)).collect();
    signals.torque = torque;
    let diagnosis = diagnose(&signals.into(), &Options { lock: Lock::Tail(0.5), ..Options::default() }).unwrap();
    assert_eq!(named(&diagnosis).first(), Some(&EffectId::PositionRipple), "{:?}", named(&diagnosis));
}

/// A pin on a plate, stroke 0.24 mm: most of the motion is break-away.
#[test]
fn the_tribometer_slides_little_beyond_break_away() {
    let joint = Joint::default();
    let Some(pin) = load("tribometer/reciprocating.csv", &joint) else { return };
    let (_, diagnosis) = diagnosed(&pin, &joint, Lock::Tail(0.5));
    let [before, after] = locked_r2(&diagnosis);
    println!("{:?}, R2 {before:.4} -> {after:.4} on the later half", named(&diagnosis));
    assert_eq!(diagnosis.findings[0].effect, EffectId::Presliding);
    assert!(after > 0.99);
}

/// A small part of `docs/real-additions.md`.
#[test]
fn what_is_added_to_the_emps_axis_is_named_and_nothing_else() {
    let Some(folder) = recordings() else { return };
    let axis = Real::load("emps/train", &listed(&folder)["emps/train"]).unwrap();
    let before = axis.found().unwrap();
    // A drift of a twentieth is told as a warm-up whose time constant the recording does not determine.
    for (effect, share) in [("stribeck", 0.05), ("slow_drift", 0.1), ("presliding", 0.05), ("position_ripple", 0.05)] {
        let added = axis.add(effect, share, &before).unwrap();
        assert!(added.is_found() && added.surplus().is_empty(), "{effect}: {:?}", added.after.told());
    }
}
