mod clock;
mod motion;
mod plant;
mod torque;

use super::*;
use crate::error::Code;
use plant::{Plant, joints};

fn reviewed(recording: Recording) -> Reviewed {
    review(recording, &Joint::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn faults(recording: Recording) -> Vec<Fault> {
    reviewed(recording).notes.into_iter().map(|note| note.fault).collect()
}

#[track_caller]
fn refused(recording: Recording, code: &'static Code) {
    let error = review(recording, &Joint::default()).expect_err("this has to be refused");
    assert_eq!((error.code().id, error.exit_status()), (code.id, 3), "{error}");
}

/// Checks that a note says these times, each end within 0.3 s.
#[track_caller]
fn assert_when(note: &Note, wanted: &[[f64; 2]]) {
    let near = |(found, wanted): (&[f64; 2], &[f64; 2])| found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 0.3);
    assert!(note.when_s.len() == wanted.len() && note.when_s.iter().zip(wanted).all(near), "{note:?} at {wanted:?}");
}

#[test]
fn a_healthy_recording_comes_back_bit_for_bit() {
    let coarse = |plant: Plant| Plant { step: plant.motion[0][0] / 300.0, ..plant };
    let slow =
        |plant: Plant| Plant { motion: vec![[plant.motion[0][0], 1.6 / plant.seconds]], rate_hz: 100.0, ..plant };
    let all = joints().into_iter().flat_map(|plant| [plant.clone(), coarse(plant.clone()), slow(plant)]);
    for plant in all {
        let recording = plant.changed(|_, row| row);
        let Reviewed { recording: same, notes } = reviewed(recording.clone());
        assert_eq!(notes, [], "{plant:?}");
        assert!(
            same.channels == recording.channels && same.health == recording.health && same.table == recording.table
        );
    }
}

#[test]
fn what_a_joint_does_is_no_fault() {
    let plant = plant::robot();
    // It rests for a while, with a torque that no longer changes.
    let rows = plant.rows();
    let rest = plant.at(8.0)..plant.at(14.0);
    let rested: Vec<plant::Row> = rows
        .iter()
        .enumerate()
        .map(|(row, [t, ..])| {
            let moved = if rest.contains(&row) {
                rest.start
            } else if row >= rest.end {
                row - rest.len()
            } else {
                row
            };
            [*t, rows[moved][1], if moved == rest.start { 0.0 } else { rows[moved][2] }, rows[moved][3]]
        })
        .collect();
    assert_eq!(faults(plant.recording(&rested)), []);
    // Where it turns round it is twice at one place, with one torque where that is recorded in coarse steps.
    let position = |row: usize| ((0.9 * (0.9012 * (row as f64 - 700.5)).cos()) / 1e-5).round() * 1e-5;
    let coarse = plant.changed(|row, [t, ..]| [t, position(row), 0.0, (position(row) / 0.5).round()]);
    assert!(position(700) == position(701) && position(702) != position(701));
    let found = faults(coarse);
    assert!(!found.iter().any(|fault| matches!(fault, Fault::RepeatedRows { .. })), "{found:?}");
    // Its drive has a limit.
    assert_eq!(faults(plant.changed(|_, [t, q, v, u]| [t, q, v, u.clamp(-1.5, 1.5)])), []);
    // Its torque is recorded in coarse steps.
    assert_eq!(faults(plant.changed(|_, [t, q, v, u]| [t, q, v, (u / 0.1).round() * 0.1])), []);
    // It is heavier on one side, and lifts more than it rubs.
    let heavy = Plant { gravity: 40.0, noise: 0.3, ..plant.clone() };
    assert_eq!(faults(heavy.changed(|_, row| row)), []);
}
