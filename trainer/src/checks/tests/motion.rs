use super::plant::{axis, joints, motor, robot};
use super::*;
use crate::recording::Quantity;
use std::f64::consts::{PI, TAU};

fn position(recording: &Recording) -> Vec<f64> {
    recording.values(Quantity::Position).unwrap().to_vec()
}

/// Largest difference of two positions that may begin at different zeros.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y - a[0] + b[0]).abs()).fold(0.0, f64::max)
}

#[test]
fn a_position_that_starts_anew_is_put_together() {
    let wrapped =
        |low: f64, period: f64| move |_: usize, [t, q, v, u]: plant::Row| [t, low + (q - low).rem_euclid(period), v, u];
    // From 0 to 360 and from -180 to 180 degrees, at 100 Hz and 500 Hz, and a magnetic scale on a linear axis.
    for (plant, low, period, count) in
        [(motor(), 0.0, TAU, 2), (motor(), -PI, TAU, 2), (robot(), 0.4, TAU, 1), (axis(), 0.0, 0.032, 9)]
    {
        let Reviewed { recording, notes } = reviewed(plant.changed(wrapped(low, period)));
        let [Note { fault: Fault::WrappedPosition { period: found, times }, when_s }] = &notes[..] else {
            panic!("{notes:?}")
        };
        assert!((found / period - 1.0).abs() < 1e-3 && *times >= count && when_s.len() == *times, "{notes:?}");
        let healthy = position(&plant.changed(|_, row| row));
        assert!(apart(&position(&recording), &healthy) < 1e-3 * period, "{:?}", plant.columns);
    }
    // A motor's own turn behind a gear.
    let joint = Joint::parse("[drive]\ngear_ratio = 9").unwrap();
    let recording = robot().changed(wrapped(0.0, TAU / 9.0));
    let reviewed = review(recording, &joint).unwrap();
    assert!(
        matches!(reviewed.notes[..], [Note { fault: Fault::WrappedPosition { period, .. }, .. }] if period == TAU / 9.0)
    );
}

#[test]
fn a_position_that_is_set_anew_is_shifted_back_and_interrupted() {
    for (plant, jumps) in
        [(robot(), vec![(11.0, 0.37)]), (axis(), vec![(3.0, -0.0012), (7.5, 0.004)]), (motor(), vec![(50.0, 2.0)])]
    {
        let shift = |row: usize| jumps.iter().filter(|(at, _)| row >= plant.at(*at)).map(|(_, by)| by).sum::<f64>();
        let Reviewed { recording, notes } = reviewed(plant.changed(|row, [t, q, v, u]| [t, q + shift(row), v, u]));
        let [note @ Note { fault: Fault::RezeroedPosition { by }, .. }] = &notes[..] else { panic!("{notes:?}") };
        let largest =
            jumps.iter().map(|(_, by)| by).fold(0.0_f64, |most, by| if by.abs() > most.abs() { *by } else { most });
        assert!((by / largest - 1.0).abs() < 0.05, "{notes:?}");
        let times: Vec<[f64; 2]> = jumps.iter().map(|(at, _)| [*at; 2]).collect();
        assert_when(note, &times);
        assert_eq!(recording.health.gaps, jumps.iter().map(|(at, _)| plant.at(*at)).collect::<Vec<_>>());
        let healthy = position(&plant.changed(|_, row| row));
        assert!(apart(&position(&recording), &healthy) < 0.02 * largest.abs(), "{:?}", plant.columns);
    }
}

#[test]
fn a_glitch_is_no_setting_anew() {
    let plant = robot();
    let glitch = plant.at(9.0)..plant.at(9.0) + 2;
    let recording = plant.changed(|row, [t, q, v, u]| [t, if glitch.contains(&row) { q + 3.0 } else { q }, v, u]);
    assert_eq!(faults(recording), []);
}

#[test]
fn a_velocity_that_contradicts_the_position_is_left_out() {
    let contradiction = |recording: Recording| {
        let Reviewed { recording, notes } = reviewed(recording);
        let [Note { fault: Fault::ContradictingVelocity(how), .. }] = notes[..] else { panic!("{notes:?}") };
        assert!(recording.channel(Quantity::Velocity).is_none());
        how
    };
    for plant in joints() {
        let rows = plant.rows();
        assert_eq!(contradiction(plant.changed(|_, [t, q, _, u]| [t, q, 0.0, u])), Contradiction::Constant(0.0));
        let late = plant.at(0.05);
        let how = contradiction(plant.changed(|row, [t, q, _, u]| [t, q, rows[row.saturating_sub(late)][2], u]));
        assert!(matches!(how, Contradiction::Late(lag) if (lag / 0.05 - 1.0).abs() < 0.15), "{how:?}");
        let how = contradiction(plant.changed(|_, [t, q, v, u]| [t, q, 50.0 * v, u]));
        assert!(matches!(how, Contradiction::Scaled(factor) if (factor / 50.0 - 1.0).abs() < 0.05), "{how:?}");
        let other = plant.at(plant.seconds / 3.0);
        let how = contradiction(plant.changed(|row, [t, q, _, u]| [t, q, rows[(row + other) % rows.len()][2], u]));
        assert!(matches!(how, Contradiction::Unrelated(_)), "{how:?}");
    }
}

#[test]
fn units_that_do_not_fit_together_block() {
    let factor = |recording: Recording| match &faults(recording)[..] {
        [Fault::WrongUnit(WrongUnit::VelocityOverDerivative(factor)), ..] => *factor,
        other => panic!("{other:?}"),
    };
    for plant in [robot(), motor()] {
        assert!((factor(plant.changed(|_, [t, q, v, u]| [t, q.to_degrees(), v, u])) * 57.296 - 1.0).abs() < 0.05);
        assert!((factor(plant.changed(|_, [t, q, v, u]| [t, q, v * 60.0 / TAU, u])) / 9.549 - 1.0).abs() < 0.05);
        assert!((factor(plant.changed(|_, [t, q, v, u]| [t, -q, v, u])) + 1.0).abs() < 0.05);
    }
    assert!((factor(axis().changed(|_, [t, q, v, u]| [t, 1e3 * q, v, u])) * 1e3 - 1.0).abs() < 0.05);
}

#[test]
fn degrees_in_both_columns_are_told_by_gravity() {
    let in_degrees = |plant: Plant| plant.changed(|_, [t, q, v, u]| [t, q.to_degrees(), v.to_degrees(), u]);
    let found = reviewed(in_degrees(robot()));
    assert!(
        matches!(found.notes[..], [Note { fault: Fault::WrongUnit(WrongUnit::PositionInDegrees(_)), .. }]),
        "{:?}",
        found.notes
    );
    assert!(found.blocking().is_some());
    // Without gravity nothing tells; many turns are no degrees.
    assert_eq!(faults(in_degrees(Plant { gravity: 0.0, ..robot() })), []);
    assert_eq!(faults(Plant { motion: vec![[60.0, 0.1], [9.0, 0.4]], ..robot() }.changed(|_, row| row)), []);
}

#[test]
fn a_joint_that_never_turns_round_is_told() {
    for plant in joints() {
        let fastest: f64 = plant.motion.iter().map(|[amplitude, frequency]| amplitude * frequency * TAU).sum();
        let forward = Plant { steady: 1.2 * fastest, ..plant };
        assert_eq!(faults(forward.changed(|_, row| row)), [Fault::OneDirection { forward: true }]);
    }
}

#[test]
fn a_position_whose_sign_is_read_as_a_digit_is_put_back() {
    for plant in joints() {
        let counts = |q: f64| (q / plant.step).round();
        let coded = |n: f64| if n < 0.0 { 2f64.powi(23) - n } else { n };
        let found = reviewed(plant.changed(|_, [t, q, v, u]| [t, coded(counts(q)) * plant.step, v, u]));
        assert!(matches!(found.notes[..], [Note { fault: Fault::SignBit { .. }, .. }]), "{:?}", found.notes);
        let position = found.recording.values(crate::recording::Quantity::Position).unwrap();
        assert!(position.iter().zip(plant.rows()).all(|(found, row)| (found - row[1]).abs() < 0.1 * plant.step));
    }
}
