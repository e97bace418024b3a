//! What the supervisor keeps a joint with LuGre friction from, one test each.

use crate::joint::{ELBOW, JOINTS, Motion, Run, Scores};

use frikan_runtime::compensator::{Exported, Status};
use frikan_runtime::supervised::adaptation_settings::AdaptationSettings;
use frikan_runtime::supervised::{Supervised, Supervision};

const ACTIVE: Supervised = Supervised::Compensator(Status::Active);

/// Within the contact nothing slides, and what the joint gives back is counted all the same.
#[test]
fn motions_within_the_contact_are_no_worse_unless_degraded() {
    for joint in JOINTS {
        for (bits, rate) in [(14, 1000.0), (16, 1000.0), (18, 250.0), (20, 1000.0)] {
            for friction in [0.2, 0.3, 0.7] {
                let run = Run { friction, rate, ..Run::of(joint, Motion::Small, bits) };
                let [without, with] = [Run { gain: 0.0, ..run }, run].map(|run| Scores::of(&run.plain()));
                assert!(
                    with.rms < 1.02 * without.rms || with.degraded > 0.8,
                    "{}, {bits} bits, {friction}: {without:?} {with:?}",
                    joint.name
                );
            }
        }
    }
}

/// The torque of a joint that stands still is gone after twice the hold time, and the joint has hardly moved.
#[test]
fn a_joint_at_rest_is_not_held_for_ever() {
    for joint in JOINTS {
        let rows = Run::of(joint, Motion::Stay, 20).plain();
        let at = |time: f64| rows.iter().find(|row| row.time >= time).unwrap();
        let (held, end) = (at(2.5), rows.last().unwrap());
        assert!(f64::from(held.answer.torque) > 0.1 * joint.coulomb, "{}: {held:?}", joint.name);
        assert_eq!((end.answer.torque, end.answer.status), (0.0, ACTIVE), "{}", joint.name);
        let moved = (end.position - held.position).abs();
        assert!(moved < (joint.coulomb + joint.stribeck) / joint.contact, "{}: {moved} rad", joint.name);
    }
}

/// Whatever the speed that is asked for.
#[test]
fn a_joint_that_is_blocked_gets_no_more_than_its_break_away() {
    for joint in JOINTS {
        let mut blocked = 0;
        for row in Run::of(joint, Motion::Blocked, 20).plain() {
            // Standing at the wall, and asked to go on.
            if row.velocity.abs() < 1.0e-3 && row.error.abs() > 0.3 {
                blocked += 1;
                let torque = f64::from(row.answer.torque).abs();
                assert!(torque < joint.coulomb + joint.stribeck, "{}: {row:?}", joint.name);
            }
        }
        assert!(blocked > 1000, "{}: the test is idle", joint.name);
    }
}

#[test]
fn a_dead_velocity_sensor_switches_the_compensation_off_once_and_until_somebody_says_so() {
    let run = Run::of(ELBOW, Motion::Sine, 18);
    let rows = run.driven(run.supervision(), |time, sample, supervisor, _| {
        if time > 2.0 && time < 6.0 {
            sample.measurement.velocity = 0.0;
        }
        if (time - 9.0).abs() < 1.0e-6 {
            supervisor.clear_fault();
        }
    });
    let switched: Vec<f64> = rows
        .windows(2)
        .filter(|pair| (pair[0].answer.status == ACTIVE) != (pair[1].answer.status == ACTIVE))
        .map(|pair| pair[1].time)
        .collect();
    assert!(switched.len() == 2 && switched[0] < 2.6 && (switched[1] - 9.0).abs() < 2.0e-3, "{switched:?}");
    assert!(rows.iter().filter(|row| row.time > 3.0 && row.time < 9.0).all(|row| row.answer.torque == 0.0));
}

#[test]
fn a_velocity_of_another_scale_is_found_in_motion() {
    for joint in JOINTS {
        for scale in [0.6, 2.0, -1.0] {
            let run = Run::of(joint, Motion::Sine, 18);
            let rows = run.rows(run.supervision(), |_, sample| sample.measurement.velocity *= scale);
            let end = rows.last().unwrap().answer;
            assert_eq!((end.status, end.torque), (Supervised::Implausible, 0.0), "{}, {scale}", joint.name);
        }
    }
}

/// One sample that is missing costs what the slew takes, and no knock.
#[test]
fn missing_samples_are_no_knock() {
    let run = Run::of(ELBOW, Motion::Sine, 18);
    let whole = Scores::of(&run.plain());
    let mut index = 0;
    let gaps = run.rows(run.supervision(), |_, sample| {
        index += 1;
        if index % 97 == 0 {
            sample.measurement.velocity = f32::NAN;
        }
    });
    let gaps = Scores::of(&gaps);
    assert!(gaps.rms < 1.1 * whole.rms && gaps.share > 0.9, "{whole:?} {gaps:?}");
}

/// A position that begins anew after a turn is the same motion, bit for bit but for the rounding of the position.
#[test]
fn a_position_that_begins_anew_is_no_jump() {
    for start in [0.2, -0.2] {
        let run = Run::of(ELBOW, Motion::Sine, 18);
        let wrapped = run.rows(run.supervision(), |_, sample| {
            let position = f64::from(sample.measurement.position) - 0.5 + start;
            sample.measurement.position = position.rem_euclid(std::f64::consts::TAU) as f32;
        });
        let [whole, wrapped] = [run.plain(), wrapped].map(|rows| Scores::of(&rows));
        assert_eq!((wrapped.implausible, wrapped.degraded), (0.0, 0.0), "{wrapped:?}");
        assert!((wrapped.rms / whole.rms - 1.0).abs() < 0.05 && wrapped.share > 0.95, "{whole:?} {wrapped:?}");
    }
}

/// A joint that has put down a payload of three times its inertia, which the firmware tells or not.
#[test]
fn an_inertia_that_is_told_is_no_friction() {
    let run = Run::of(ELBOW, Motion::Sine, 18);
    let loaded = Supervision { inertia: 4.0 * ELBOW.inertia as f32, ..run.supervision() };
    let score = |inertia: f64| {
        Scores::of(&run.driven(loaded, |_, _, supervisor, _| supervisor.set_inertia(inertia as f32).unwrap()))
    };
    let [told, untold] = [ELBOW.inertia, 4.0 * ELBOW.inertia].map(score);
    assert!(told.share > 0.95 && told.rms < 0.8 * untold.rms && untold.share < 0.9, "{told:?} {untold:?}");
}

/// What was learnt on a model of half the friction does not multiply the next.
#[test]
fn a_swapped_model_is_begun_anew() {
    let run = Run::of(ELBOW, Motion::Sine, 18);
    let adaptation = AdaptationSettings::new([0.5, 2.0], [0.0, 0.0], 1.5, 0.1).unwrap();
    let supervision = Supervision { adaptation: Some(adaptation), ..run.supervision() };
    let rows = run.driven(supervision, |time, _, _, compensator| {
        if time == 0.0 {
            compensator.replace(Ok(Exported(ELBOW.law(0.6))));
        }
        if (time - 8.0).abs() < 1.0e-6 {
            compensator.replace(Ok(Exported(ELBOW.law(1.0))));
        }
    });
    let level = |time: f64| rows.iter().find(|row| row.time >= time).unwrap().answer.correction.level;
    assert!(level(7.9) > 1.4 && (level(8.01) - 1.0).abs() < 0.05, "{} {}", level(7.9), level(8.01));
    assert!(rows.iter().filter(|row| row.time > 8.0).all(|row| row.answer.correction.level < 1.2));
}
