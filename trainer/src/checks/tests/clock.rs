use super::plant::{axis, joints, motor, robot};
use super::*;
use crate::checks::survey::{Seen, survey};
use crate::error::codes;

#[test]
fn a_clock_in_another_unit_is_refused() {
    for plant in joints() {
        let ms = 1e3 * 20.0;
        refused(plant.changed(|_, [t, q, v, u]| [ms * t, q, v, u]), &codes::IMPLAUSIBLE_CLOCK);
        refused(plant.changed(|_, [t, q, v, u]| [1e6 * t, q, v, u]), &codes::IMPLAUSIBLE_CLOCK);
        refused(plant.changed(|row, [_, q, v, u]| [row as f64 * 1e-9, q, v, u]), &codes::IMPLAUSIBLE_CLOCK);
    }
    // At 5 kHz a millisecond passes for a slow clock: the velocity tells.
    let fault = faults(axis().changed(|_, [t, q, v, u]| [1e3 * t, q, v, u]));
    assert!(
        matches!(fault[..], [Fault::WrongUnit(WrongUnit::VelocityOverDerivative(factor)), ..] if (factor / 1e3 - 1.0).abs() < 0.05),
        "{fault:?}"
    );
}

#[test]
fn a_slow_log_with_a_velocity_is_none() {
    let slow = plant::Plant { rate_hz: 0.5, seconds: 2000.0, motion: vec![[0.9, 0.004], [0.2, 0.013]], ..robot() };
    assert!(review(slow.changed(|_, row| row), &Joint::default()).is_ok());
}

#[test]
fn a_clock_that_stands_still_is_refused() {
    refused(motor().changed(|_, [_, q, v, u]| [1.0, q, v, u]), &codes::TIME_NOT_INCREASING);
}

#[test]
fn what_was_left_out_between_stretches_is_no_interruption() {
    let jump = |row: usize| {
        if row > 900 {
            1000.0
        } else if row > 300 {
            1.0
        } else {
            0.0
        }
    };
    let mut recording = robot().changed(|row, [t, q, v, u]| [t + jump(row), q, v, u]);
    let gaps = |recording: &Recording| {
        let facts = survey(recording);
        facts.iter().find(|fact| matches!(fact.seen, Seen::Gaps { .. })).map_or(0, |fact| fact.when_s.len())
    };
    assert_eq!(gaps(&recording), 2);
    recording.is_excerpt = true;
    assert_eq!(gaps(&recording), 1);
}

#[test]
fn repeated_rows_and_stamps_are_left_out_and_counted() {
    for plant in joints() {
        let rows = plant.rows();
        let twice = |row: usize| row % 7 == 3;
        let repeated: Vec<_> =
            (0..rows.len()).flat_map(|row| [rows[row]].repeat(1 + usize::from(twice(row)))).collect();
        let Reviewed { recording, notes } = reviewed(plant.recording(&repeated));
        let count = (0..rows.len()).filter(|row| twice(*row)).count();
        assert_eq!(
            notes.iter().map(|note| note.fault.clone()).collect::<Vec<_>>(),
            [Fault::RepeatedRows { rows: count }]
        );
        assert_eq!(recording.channels, plant.recording(&rows).channels);
        assert_eq!(recording.table.row(4).collect::<Vec<_>>(), plant.recording(&rows).table.row(4).collect::<Vec<_>>());
    }
    // A clock of milliseconds beside 2 kHz.
    let fast = plant::Plant { rate_hz: 2000.0, ..robot() };
    let coarse = fast.changed(|row, [_, q, v, u]| [(row / 2) as f64 * 1e-3, q, v, u]);
    let Reviewed { recording, notes } = reviewed(coarse);
    assert_eq!(notes[0].fault, Fault::RepeatedStamps { rows: 30_000 });
    assert!((recording.health.period_s.unwrap() - 1e-3).abs() < 1e-9);
}

#[test]
fn a_row_that_is_written_again_while_the_joint_moves_is_left_out() {
    let plant = robot();
    let rows = plant.rows();
    let late = |row: usize| row % 50 == 20;
    let again =
        plant.changed(
            |row, [t, q, v, u]| {
                if late(row) { [t, rows[row - 1][1], rows[row - 1][2], rows[row - 1][3]] } else { [t, q, v, u] }
            },
        );
    let Reviewed { recording, notes } = reviewed(again);
    let [Note { fault: Fault::RepeatedRows { rows: count }, .. }] = notes[..] else { panic!("{notes:?}") };
    // Those while it moves by more than a few steps of its encoder.
    assert!(count > 250 && count <= 300 && recording.len() == rows.len() - count, "{count}");
}

#[test]
fn held_samples_are_used_at_their_own_rate() {
    for (plant, every) in joints().into_iter().zip([4, 25, 3]) {
        let rows = plant.rows();
        let fresh = |row: usize| rows[row / every * every];
        // All channels, the position alone, the torque alone.
        let all = plant.changed(|row, [t, ..]| [t, fresh(row)[1], fresh(row)[2], fresh(row)[3]]);
        let position = plant.changed(|row, [t, _, v, u]| [t, fresh(row)[1], v, u]);
        let torque = plant.changed(|row, [t, q, v, _]| [t, q, v, fresh(row)[3]]);
        for recording in [all, position, torque] {
            let Reviewed { recording, notes } = reviewed(recording);
            let [Note { fault: Fault::HeldSamples { every: found, rate_hz, .. }, .. }] = &notes[..] else {
                panic!("{notes:?}")
            };
            assert!(*found == every && (rate_hz * every as f64 / plant.rate_hz - 1.0).abs() < 1e-6, "{notes:?}");
            let time = recording.values(crate::recording::Quantity::Time).unwrap();
            assert!((time[10] - time[9] - every as f64 / plant.rate_hz).abs() < 1e-9);
        }
    }
}
