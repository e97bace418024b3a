use super::rigid_body::{TermKind, separate};
use super::*;
use crate::error::Code;
use crate::joint::Joint;
use crate::recording::{Recording, parse};

const RATE_HZ: f64 = 1000.0;
const INERTIA: f64 = 0.5;
const GRAVITY: f64 = 4.0;
const PHASE: f64 = 0.3;
const OFFSET: f64 = 0.2;

/// A joint that swings through +-1.5 rad at two frequencies, with Coulomb and viscous friction and gravity. `step` is
/// the resolution of its encoder, rad (zero for an ideal one); `clock` moves the time of sample `i`.
fn swing(seconds: f64, step: f64, clock: impl Fn(usize, f64) -> f64) -> String {
    let mut text = String::from("time_s,position_rad,torque_Nm,temperature_C\n");
    let mut noise = 0u64;
    for i in 0..(seconds * RATE_HZ) as usize {
        let t = clock(i, i as f64 / RATE_HZ);
        let (a, b) = (1.2, 4.1);
        let q = 1.2 * (a * t).sin() + 0.3 * (b * t).sin();
        let v = 1.2 * a * (a * t).cos() + 0.3 * b * (b * t).cos();
        let acceleration = -1.2 * a * a * (a * t).sin() - 0.3 * b * b * (b * t).sin();
        let friction = 2.0 * (v / 1e-3).tanh() + 1.2 * v;
        noise = noise.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let disturbance = 0.2 * ((noise >> 11) as f64 / (1u64 << 53) as f64 - 0.5);
        let torque = INERTIA * acceleration + GRAVITY * (q + PHASE).sin() + OFFSET + friction + disturbance;
        let read = if step > 0.0 { (q / step).round() * step } else { q };
        text += &format!("{t},{read},{torque},30\n");
    }
    text
}

fn recording(text: &str) -> Recording {
    parse("swing.csv", text.as_bytes(), &Joint::default()).unwrap()
}

fn prepared(recording: &Recording) -> (Preparation, Samples) {
    let preparation = Preparation::plan(&[recording], &Joint::default(), &Request::default()).unwrap();
    (preparation, prepare(recording, &preparation).unwrap())
}

fn value(separation: &rigid_body::Separation, kind: TermKind) -> (f64, f64) {
    let found = separation.parameters.iter().find(|parameter| parameter.kind == kind).unwrap();
    (found.value, found.standard_error)
}

#[test]
fn rigid_body_parameters_come_back_within_their_standard_errors() {
    let (_, samples) = prepared(&recording(&swing(20.0, 1e-6, |_, t| t)));
    let separation = separate(&samples, &Joint::default()).unwrap();
    assert_eq!(separation.rank_deficiency, 0);
    for (kind, truth) in [
        (TermKind::Inertia, INERTIA),
        (TermKind::GravitySine, GRAVITY * PHASE.cos()),
        (TermKind::GravityCosine, GRAVITY * PHASE.sin()),
        (TermKind::TorqueOffset, OFFSET),
    ] {
        let (found, error) = value(&separation, kind);
        assert!((found - truth).abs() < 5.0 * error + 0.01, "{kind:?} {found} +- {error} against {truth}");
        assert!(error < 0.05, "{kind:?} {error}");
    }
    let velocity = samples.velocity.as_deref().unwrap();
    let worst = separation
        .friction
        .iter()
        .zip(velocity)
        .filter(|(_, v)| v.abs() > 0.2)
        .map(|(f, v)| (f - 2.0 * v.signum() - 1.2 * v).abs())
        .fold(0.0, f64::max);
    assert!(worst < 0.25, "{worst}");
}

#[test]
fn given_parameters_are_subtracted_and_not_asked_for_again() {
    let (_, samples) = prepared(&recording(&swing(10.0, 1e-6, |_, t| t)));
    let joint = Joint::parse(&format!(
        "[rigid_body]\ninertia_kgm2 = {INERTIA}\ngravity_torque_Nm = {GRAVITY}\ngravity_phase_rad = {PHASE}"
    ))
    .unwrap();
    let separation = separate(&samples, &joint).unwrap();
    assert_eq!(separation.parameters.len(), 1);
    let (offset, _) = value(&separation, TermKind::TorqueOffset);
    assert!((offset - OFFSET).abs() < 0.03, "{offset}");
    assert!((separation.inertia() - INERTIA).abs() < 1e-12);
}

#[test]
fn a_coarser_encoder_gets_a_wider_filter_and_the_same_inertia() {
    let mut widths = Vec::new();
    for step in [1e-6, 1e-4, 1e-3] {
        let (preparation, samples) = prepared(&recording(&swing(20.0, step, |_, t| t)));
        let separation = separate(&samples, &Joint::default()).unwrap();
        let (inertia, error) = value(&separation, TermKind::Inertia);
        assert!((inertia / INERTIA - 1.0).abs() < 0.03, "{inertia} +- {error} at {step}");
        widths.push(preparation.sigma_s.unwrap());
    }
    assert!(widths[0] < widths[1] && widths[1] < widths[2], "{widths:?}");
}

#[test]
fn gaps_split_segments_and_jitter_is_resampled() {
    let gap = recording(&swing(6.0, 0.0, |i, t| if i >= 2500 { t + 0.5 } else { t }));
    let (_, samples) = prepared(&gap);
    assert_eq!(samples.segments.len(), 2);
    let (before, after) = (samples.segments[0].end - 1, samples.segments[1].start);
    assert!(samples.time[before] < 2.5 && samples.time[after] > 3.0);

    let jitter = recording(&swing(6.0, 0.0, |i, t| t + if i % 3 == 0 { 3e-4 } else { 0.0 }));
    // Stamps that are rounded only are said nothing of.
    let rounded = recording(&swing(6.0, 0.0, |_, t| (1e6 * t).round() / 1e6 + 2.5e-9 * (t * 1e5).sin()));
    assert_eq!(told_of_clock([&rounded, &gap]), "");
    assert!(told_of_clock([&rounded, &jitter]).contains("uneven time stamps"));
    let (_, samples) = prepared(&jitter);
    let truth = |t: f64| 1.2 * 1.2 * (1.2 * t).cos() + 0.3 * 4.1 * (4.1 * t).cos();
    for (t, v) in samples.time.iter().zip(samples.velocity.as_deref().unwrap()) {
        assert!((v - truth(*t)).abs() < 5e-3, "{v} at {t}");
    }
}

#[test]
fn every_row_gets_a_sample_at_its_own_time() {
    let recording = recording(&swing(5.0, 1e-6, |i, t| t + if i % 3 == 0 { 3e-4 } else { 0.0 }));
    let (preparation, samples) = prepared(&recording);
    let rows = prepare_every_row(&recording, &preparation).unwrap();
    assert_eq!(rows.len(), recording.len());
    assert_eq!(rows.velocity.as_deref().unwrap().len(), recording.len());
    assert!(samples.len() < rows.len());
    // Away from the ends a row's velocity is that of the samples at the same time.
    let middle = samples.len() / 2;
    let row = rows.time.partition_point(|t| *t < samples.time[middle]);
    let difference = rows.velocity.as_deref().unwrap()[row] - samples.velocity.as_deref().unwrap()[middle];
    assert!(difference.abs() < 0.01, "{difference}");
}

#[test]
fn recordings_are_joined_in_order_or_refused() {
    let first = recording(&swing(4.0, 1e-6, |_, t| t));
    let (preparation, part) = prepared(&first);
    let joined = Samples::join(vec![part.clone(), part.clone()]).unwrap();
    assert_eq!((joined.len(), joined.segments.len(), joined.recordings.len()), (2 * part.len(), 2, 2));
    assert_eq!(joined.segments[1], part.len()..2 * part.len());
    let other =
        parse("other.csv", swing(4.0, 1e-6, |_, t| t).replace("torque_Nm", "current_A").as_bytes(), &Joint::default())
            .unwrap();
    let other = prepare(&other, &preparation).unwrap();
    assert_eq!(Samples::join(vec![part, other]).unwrap_err().code().id, "FRK-D018");
}

#[track_caller]
fn plan_refused(text: &str, code: &'static Code) {
    let error = match parse("bad.csv", text.as_bytes(), &Joint::default()) {
        Err(error) => error,
        Ok(recording) => {
            Preparation::plan(&[&recording], &Joint::default(), &Request::default()).expect_err("has to be refused")
        }
    };
    assert_eq!((error.code().id, error.file().is_some()), (code.id, true), "{error}");
}

#[test]
fn motions_that_tell_nothing_are_refused() {
    use std::fmt::Write;
    let table = |header: &str, row: &dyn Fn(f64) -> String| {
        (0..400).fold(format!("{header}\n"), |mut text, i| {
            writeln!(text, "{}", row(f64::from(i) * 0.01)).unwrap();
            text
        })
    };
    plan_refused(&table("time_s,position_rad,torque_Nm", &|t| format!("{t},{},1", 0.7 * t)), &codes::NO_MOTION);
    plan_refused(&table("time_s,position_rad,torque_Nm", &|t| format!("{t},0.5,1")), &codes::NO_MOTION);
    plan_refused(&table("time_s,velocity_rad_s,torque_Nm", &|t| format!("{t},0.5,1")), &codes::NO_MOTION);
    plan_refused(&table("velocity_rad_s,friction_torque_Nm", &|_| "0.5,1".to_owned()), &codes::NO_MOTION);
    plan_refused(&table("position_rad,torque_Nm", &|t| format!("{t},1")), &codes::MISSING_COLUMN);
    plan_refused(&table("time_s,torque_Nm", &|t| format!("{t},1")), &codes::MISSING_COLUMN);
}

#[test]
fn a_current_needs_the_torque_constant_only_beside_a_rigid_body_in_newton_metres() {
    let text = swing(4.0, 1e-6, |_, t| t).replace("torque_Nm", "current_A");
    let (_, samples) = prepared(&recording(&text));
    assert!(separate(&samples, &Joint::default()).is_ok());
    let joint = Joint::parse("[rigid_body]\ninertia_kgm2 = 0.5").unwrap();
    assert_eq!(separate(&samples, &joint).unwrap_err().code().id, "FRK-D014");
    let joint = Joint::parse("[rigid_body]\ninertia_kgm2 = 0.5\n[drive]\ntorque_constant_Nm_A = 2").unwrap();
    assert!((separate(&samples, &joint).unwrap().inertia() - 0.25).abs() < 1e-12);
}

#[test]
fn a_separated_recording_is_taken_as_it_is() {
    let text = (0..200).fold("velocity_rad_s,friction_torque_Nm,load_torque_Nm\n".to_owned(), |text, i| {
        let v = (f64::from(i) * 0.1).sin();
        text + &format!("{v},{},{i}\n", 2.0 * v.signum() + v)
    });
    let (preparation, samples) = prepared(&recording(&text));
    assert_eq!((preparation.sigma_s, samples.len(), samples.rate_hz), (None, 200, None));
    assert!(samples.friction.is_some() && samples.time.is_empty());
    assert_eq!(samples.input("load").unwrap()[7], 7.0);
    assert_eq!(samples.require_input("humidity").unwrap_err().code().id, "FRK-U002");
}

impl Samples {
    /// Samples at 100 Hz of one recording of which nothing but the velocity is known.
    pub(super) fn of_velocity(velocity: Vec<f64>) -> Self {
        let rows = 0..velocity.len();
        Self {
            axis: Axis::Rotary,
            time: rows.clone().map(|i| i as f64 * 0.01).collect(),
            position: None,
            velocity: Some(velocity),
            acceleration: None,
            actuator: None,
            actuator_unit: "Nm",
            rigid_body: None,
            friction: None,
            recorded: None,
            channels: Vec::new(),
            segments: vec![rows.clone()],
            recordings: vec![("made".into(), rows)],
            rate_hz: Some(100.0),
            sigma_s: None,
            filter: String::new(),
        }
    }
}
