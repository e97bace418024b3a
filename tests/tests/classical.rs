//! Classical test runs: strokes of constant speed, a coast-down with the torque off, a ramp from a drive's own log without a position. Each is fitted
//! with what it determines.

use std::fmt::Write;

use frikan_trainer::fit::outcome::Outcome;
use frikan_trainer::fit::{Options, Training, fit};
use frikan_trainer::joint::Joint;
use frikan_trainer::kan::Random;
use frikan_trainer::recording::{Recording, parse};
use frikan_trainer::workflow::diagnose::{Against, BaseKind, Request};

const COULOMB: f64 = 0.8;
const STRIBECK: f64 = 0.4;
const VISCOUS: f64 = 0.4;
const INERTIA: f64 = 0.05;
const GIVEN_INERTIA: &str = "[rigid_body]\ninertia_kgm2 = 0.05\ngravity_torque_Nm = 0.0\n";

/// Coulomb, Stribeck (Gaussian, 0.1 rad/s) and viscous friction, N m.
fn friction(velocity: f64) -> f64 {
    (COULOMB + STRIBECK * (-(velocity / 0.1).powi(2)).exp()) * velocity.signum() + VISCOUS * velocity
}

fn joint(text: &str) -> Joint {
    Joint::parse(text).unwrap()
}

fn table(name: &str, header: &str, rows: impl Iterator<Item = [f64; 3]>) -> Recording {
    let mut text = format!("{header}\n");
    for [time, motion, torque] in rows {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{time:.4},{motion:.5},{torque:.6}");
    }
    parse(name, text.as_bytes(), &Joint::default()).unwrap()
}

fn fitted(recordings: &[Recording], known: &str) -> Outcome {
    let training = Training { restarts: Some(1), steps: Some(30), refinements: Some(1), ..Training::default() };
    let options = Options { seed: 1, training, ..Options::default() };
    fit(recordings, &[], &joint(known), &options, &|_| ()).unwrap()
}

fn near(outcome: &Outcome, wanted: &[(&str, f64, f64)]) {
    for (name, value, share) in wanted {
        let found = outcome.parameters.iter().find(|p| p.name == *name).map_or(0.0, |p| p.value);
        assert!((found / value - 1.0).abs() < *share, "{name} {found} for {value}: {:?}", outcome.parameters);
    }
}

/// Positions of an even speed are a straight line up to their last digit: the inertia was 1e9 kg m2 then, and no image could hold it.
#[test]
fn strokes_of_constant_speed_there_and_back_show_the_stribeck_shape_and_no_inertia() {
    let mut random = Random::new(6, 0);
    let speeds = [0.02, -0.02, 0.05, -0.05, 0.1, -0.1, 0.2, -0.2, 0.5, -0.5, 1.0, -1.0];
    let recordings = speeds.map(|speed: f64| {
        let mut row = |i: i32| {
            let time = 0.005 * f64::from(i);
            [time, speed * time, friction(speed) + 0.15 + 0.03 * random.normal()]
        };
        let rows: Vec<[f64; 3]> = (0..600).map(&mut row).collect();
        table(&format!("{speed}.csv"), "time_s,position_rad,torque_Nm", rows.into_iter())
    });
    let outcome = fitted(&recordings, "");
    near(&outcome, &[("stribeck_extra_torque", STRIBECK, 0.05), ("coulomb_torque", COULOMB, 0.02)]);
    near(&outcome, &[("viscous_coefficient", VISCOUS, 0.05), ("torque_offset", 0.15, 0.05)]);
    assert!(outcome.remarks.iter().any(|remark| remark.contains("inertia")), "{:?}", outcome.remarks);
}

/// Without one of two recordings of one direction each, friction is an offset: blocks of both are held out instead.
#[test]
fn a_coast_down_in_each_direction_shows_both_parts_of_friction() {
    let coast = |name: &str, begin: f64| {
        let (mut position, mut velocity) = (0.0, begin);
        let mut rows = Vec::new();
        while f64::signum(begin) * velocity > 0.0 {
            rows.push([0.005 * rows.len() as f64, position, 0.0]);
            for _ in 0..50 {
                velocity -= 1e-4 * (COULOMB * f64::signum(begin) + VISCOUS * velocity) / INERTIA;
                position += 1e-4 * velocity;
            }
        }
        table(name, "time_s,position_rad,torque_Nm", rows.into_iter())
    };
    let outcome = fitted(&[coast("there.csv", 20.0), coast("back.csv", -15.0)], GIVEN_INERTIA);
    near(&outcome, &[("coulomb_torque", COULOMB, 0.05), ("viscous_coefficient", VISCOUS, 0.05)]);
}

#[test]
fn a_ramp_in_the_log_of_a_drive_needs_no_position() {
    let mut random = Random::new(7, 0);
    let mut row = |i: i32| {
        let time = 0.005 * f64::from(i);
        let phase = (time / 15.0).rem_euclid(4.0);
        let (velocity, slope) = match phase {
            phase if phase < 1.0 => (phase, 1.0),
            phase if phase < 3.0 => (2.0 - phase, -1.0),
            phase => (phase - 4.0, 1.0),
        };
        let torque = INERTIA * 1.2 * slope / 15.0 + friction(1.2 * velocity) + 0.03 * random.normal();
        [time, 1.2 * velocity + 0.002 * random.normal(), torque]
    };
    let rows: Vec<[f64; 3]> = (1..12_000).map(&mut row).collect();
    let recording = table("drive.csv", "time_s,velocity_rad_s,torque_Nm", rows.into_iter());
    let outcome = fitted(&[recording], GIVEN_INERTIA);
    near(&outcome, &[("coulomb_torque", COULOMB, 0.03), ("viscous_coefficient", VISCOUS, 0.1)]);
}

/// Pistons drawn to and fro at one speed against a pressure, whose seal bends before it slides: the force that stays was a spring, or friction of one
/// direction that drives the joint in the other.
#[test]
fn a_force_that_stays_is_an_offset() {
    let folder = tempfile::tempdir().unwrap();
    for (seed, bend) in [(1, 4e-4), (2, 4e-4), (3, 2e-4)] {
        let mut random = Random::new(seed, 0);
        let (mut position, mut held) = (0.0, 0.0_f64);
        let mut text = String::from("time_s,position_m,force_N\n");
        for row in 0..6000 {
            let way = if row / 300 % 2 == 0 { 1.0 } else { -1.0 };
            position += way * 0.0133 * 0.01;
            held = (held + way * 0.0133 * 0.01 / bend).clamp(-1.0, 1.0);
            let force = 12.0 * held + 2.0 * way + 48.0 + 0.25 * random.normal();
            let _ = writeln!(text, "{:.2},{:.6},{force:.4}", 0.01 * f64::from(row), position + 5e-6 * random.normal());
        }
        let path = folder.path().join("strokes.csv");
        std::fs::write(&path, text).unwrap();
        let request = Request::of(&[path.as_path().into()], Against::Itself(BaseKind::CoulombViscous));
        let found = frikan_trainer::diagnose(&request, &Joint::default(), &|_| ()).unwrap();
        let first = found.diagnosis.findings.first().map(|finding| finding.effect.name());
        assert_eq!(first, Some("torque_offset"), "{}", found.text());
    }
}

/// Strokes under three pressures: what the pressure does is told in N per bar, and neither friction nor offset hold any of it.
#[test]
fn a_known_other_force_is_fitted_with_the_body_and_taken_off() {
    let known = joint("forces = [\"pressure_bar\"]\n");
    let folder = tempfile::tempdir().unwrap();
    let mut random = Random::new(9, 0);
    let paths = [1.0, 2.0, 3.0].map(|bar: f64| {
        let mut text = String::from("time_s,position_m,force_N,pressure_bar\n");
        let mut position = 0.0;
        for row in 0..3000 {
            let stroke = row / 250;
            let speed = [0.005, 0.009, 0.013, 0.02][stroke / 2 % 4] * if stroke % 2 == 0 { 1.0 } else { -1.0 };
            position += 0.01 * speed;
            let pressure = bar + 0.01 * random.normal();
            let force = 50.0 * pressure + 12.0 * f64::signum(speed) + 150.0 * speed + 0.2 * random.normal();
            let _ = writeln!(text, "{:.2},{position:.6},{force:.4},{pressure:.5}", 0.01 * row as f64);
        }
        let path = folder.path().join(format!("{bar}.csv"));
        std::fs::write(&path, text).unwrap();
        path
    });
    let sources = paths.each_ref().map(|path| path.as_path().into());
    let training = Training { restarts: Some(1), steps: Some(30), refinements: Some(1), ..Training::default() };
    let options = Options { seed: 1, training, ..Options::default() };
    let fitted = frikan_trainer::fit(&sources, &[], &known, &options, &|_| ()).unwrap();
    near(
        &fitted.outcome,
        &[("pressure_bar", 50.0, 0.01), ("coulomb_force", 12.0, 0.03), ("viscous_coefficient", 150.0, 0.1)],
    );
    let request = Request::of(&sources, Against::Itself(BaseKind::CoulombViscous));
    let found = frikan_trainer::diagnose(&request, &known, &|_| ()).unwrap();
    assert!(found.diagnosis.findings.is_empty() && found.text().contains("N per pressure_bar"), "{}", found.text());
    // At one pressure it cannot be told from an offset.
    let fitted = frikan_trainer::fit(&sources[..1], &[], &known, &options, &|_| ()).unwrap();
    assert!(
        fitted.outcome.remarks.iter().any(|remark| remark.contains("pressure_bar")),
        "{:?}",
        fitted.outcome.remarks
    );
}
