use super::plant::{axis, joints, motor, robot};
use super::*;
use crate::error::codes;
use crate::recording::Quantity;
use std::ops::Range;

#[test]
fn a_torque_that_was_not_measured_is_refused() {
    for plant in joints() {
        refused(plant.changed(|_, [t, q, v, _]| [t, q, v, 0.0]), &codes::NOT_MEASURED);
        refused(plant.changed(|_, [t, q, v, _]| [t, q, v, -3.7]), &codes::NOT_MEASURED);
        let memory = [0.0, 5e-324, 1e-321, 1.2e-314, 3e-40];
        refused(plant.changed(|row, [t, q, v, _]| [t, q, v, memory[row * row % 5]]), &codes::NOT_MEASURED);
    }
    // At one speed a constant torque may be right, and so may one level of friction.
    let steady = |row: usize, [t, ..]: plant::Row| [t, 0.5 * t + 1e-6 * (row % 3) as f64, 0.5, 2.0];
    assert_eq!(faults(robot().changed(steady)), [Fault::OneDirection { forward: true }]);
    let level = Plant { columns: ["time_s", "position_rad", "velocity_rad_s", "friction_torque_Nm"], ..robot() };
    assert_eq!(faults(level.changed(|_, [t, q, v, _]| [t, q, v, 2.0])), []);
    // A tiny torque is one.
    let tiny = robot().changed(|_, [t, q, v, u]| [t, q, v, 1e-9 * u]);
    assert_eq!(faults(tiny), []);
}

#[test]
fn no_torque_is_one_where_a_known_inertia_coasts() {
    let coasting = |_: usize, [t, ..]: plant::Row| [t, 8.0 * (1.0 - (-0.2 * t).exp()), 1.6 * (-0.2 * t).exp(), 0.0];
    let joint = Joint::parse("[rigid_body]\ninertia_kgm2 = 0.05\ngravity_torque_Nm = 0.0\n").unwrap();
    let found = review(robot().changed(coasting), &joint).unwrap().notes;
    assert!(matches!(found[..], [Note { fault: Fault::OneDirection { forward: true }, .. }]), "{found:?}");
    refused(robot().changed(coasting), &codes::NOT_MEASURED);
    // At one speed it says nothing of friction.
    let steady = |_: usize, [t, ..]: plant::Row| [t, 0.5 * t, 0.5, 0.0];
    assert!(review(robot().changed(steady), &joint).is_err());
}

#[test]
fn a_torque_of_the_wrong_sign_blocks() {
    for plant in joints() {
        let found = reviewed(plant.changed(|_, [t, q, v, u]| [t, q, v, -u]));
        let [Note { fault: Fault::WrongSign { work, dissipation }, .. }] = &found.notes[..] else {
            panic!("{:?}", found.notes)
        };
        assert!(*work < 0.0 && dissipation[0] < -4.0 * dissipation[1] && found.blocking().is_some());
    }
    // Too slow for an inertia to show.
    let creeping =
        Plant { motion: vec![[0.8, 0.05], [0.1, 0.13]], seconds: 120.0, rate_hz: 100.0, gravity: 0.0, ..robot() };
    let found = faults(creeping.changed(|_, [t, q, v, u]| [t, q, v, -u]));
    assert!(matches!(found[..], [Fault::WrongSign { .. }]), "{found:?}");
}

#[test]
fn a_joint_that_others_drive_is_not_accused() {
    let plant = robot();
    // Another joint swings it: a torque along its motion that is none of its own, larger than its friction.
    let driven = plant.changed(|_, [t, q, v, u]| [t, q, v, u - 3.0 * v]);
    assert_eq!(faults(driven), []);
    // It is let down slowly and lifted fast by something else: it only ever brakes.
    let lowered = Plant { steady: 2.0, gravity: 0.0, ..plant.clone() };
    let found = faults(lowered.changed(|_, [t, q, v, u]| [t, q, v, u - 9.0]));
    assert_eq!(found, [Fault::OneDirection { forward: true }]);
}

#[test]
fn a_torque_turned_for_a_while_is_left_out() {
    for (plant, when) in [(robot(), [4.0, 9.5]), (axis(), [6.0, 7.1]), (motor(), [41.0, 77.0])] {
        let turned = plant.at(when[0])..plant.at(when[1]);
        let found = reviewed(plant.changed(|row, [t, q, v, u]| [t, q, v, if turned.contains(&row) { -u } else { u }]));
        let [note @ Note { fault: Fault::TurnedTorque { rows }, .. }] = &found.notes[..] else {
            panic!("{:?}", found.notes)
        };
        let near = |(found, wanted): (&f64, &f64)| (found - wanted).abs() < 0.012 * plant.seconds + 0.4;
        assert!(note.when_s.len() == 1 && note.when_s[0].iter().zip(&when).all(near), "{note:?}");
        assert_eq!(found.recording.len(), (plant.rate_hz * plant.seconds) as usize - rows);
        assert_eq!(found.recording.health.gaps.len(), 1);
    }
}

#[test]
fn a_torque_that_drops_out_is_left_out() {
    for (plant, when) in [(robot(), [4.0, 9.5]), (axis(), [6.0, 6.4]), (motor(), [41.0, 60.0])] {
        let out: Range<usize> = plant.at(when[0])..plant.at(when[1]);
        let last = plant.rows()[out.start - 1][3];
        for value in [0.0, last] {
            let found =
                reviewed(plant.changed(|row, [t, q, v, u]| [t, q, v, if out.contains(&row) { value } else { u }]));
            let [note @ Note { fault: Fault::FrozenTorque { rows, .. }, .. }] = &found.notes[..] else {
                panic!("{:?}", found.notes)
            };
            assert_when(note, &[when]);
            assert!(
                rows.abs_diff(out.len()) <= 1
                    && found.recording.health.gaps == [plant.at(when[0]) - (rows - out.len())],
                "{note:?}"
            );
            let time = found.recording.values(Quantity::Time).unwrap();
            assert!(time.iter().all(|t| *t < when[0] + 1e-9 || *t >= when[1] - 1e-9));
        }
    }
}

#[test]
fn a_drive_that_is_switched_off_is_believed() {
    // A pendulum that is let go after a gap of the clock swings by itself: its torque is zero, and has to be.
    let plant = Plant { coulomb: 0.02, viscous: 0.01, ..robot() };
    let mut rows = plant.rows();
    let (begin, step) = (plant.seconds + 1.0, 1e-5);
    let [mut q, mut v] = [1.2_f64, 0.0_f64];
    for row in 0..plant.at(6.0) {
        rows.push([begin + row as f64 / plant.rate_hz, q, v, 0.0]);
        for _ in 0..(1.0 / (plant.rate_hz * step)) as usize {
            let resisting = plant.coulomb * (v / 1e-3).tanh() + plant.viscous * v;
            v -= step * (plant.gravity * q.sin() + resisting) / plant.inertia;
            q += step * v;
        }
    }
    assert_eq!(faults(plant.recording(&rows)), []);
    // The same torque where the motion asks for another one is not believed.
    let off = plant.at(10.0)..plant.at(14.0);
    rows[off].iter_mut().for_each(|row| row[3] = 0.0);
    let found = reviewed(plant.recording(&rows));
    let [note @ Note { fault: Fault::FrozenTorque { .. }, .. }] = &found.notes[..] else { panic!("{:?}", found.notes) };
    assert_when(note, &[[10.0, 14.0]]);
}

#[test]
fn a_torque_without_its_sign_blocks_and_a_load_that_never_changes_its_own_does_not() {
    for plant in joints() {
        let found = faults(plant.changed(|_, [t, q, v, u]| [t, q, v, u.abs()]));
        assert!(matches!(found[..], [Fault::LostSign { .. }]), "{found:?}");
        let load = 3.0 * plant.rows().iter().fold(0.0_f64, |peak, row| peak.max(row[3].abs()));
        assert_eq!(faults(plant.changed(|_, [t, q, v, u]| [t, q, v, u + load])), []);
    }
}

#[test]
fn negative_numbers_read_as_large_ones_are_put_back() {
    for plant in joints() {
        let step = plant.rows().iter().fold(0.0_f64, |peak, row| peak.max(row[3].abs())) / 2000.0;
        let counts = |u: f64| (u / step).round();
        let codings: [fn(f64) -> f64; 2] =
            [|n| if n < 0.0 { 32768.0 - n } else { n }, |n| if n < 0.0 { 65536.0 + n } else { n }];
        let right = plant.changed(|_, [t, q, v, u]| [t, q, v, counts(u) * step]);
        let wanted = right.actuator().unwrap().values.clone();
        for coding in codings {
            let found = reviewed(plant.changed(|_, [t, q, v, u]| [t, q, v, coding(counts(u)) * step]));
            let [Note { fault: Fault::SignBit { times, .. }, .. }] = &found.notes[..] else {
                panic!("{:?}", found.notes)
            };
            let values = &found.recording.actuator().unwrap().values;
            assert!(
                *times > 5 && values.iter().zip(&wanted).all(|(found, wanted)| (found - wanted).abs() < 0.1 * step)
            );
        }
    }
}
