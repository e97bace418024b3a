use super::*;
use crate::actuator::{Actuator, Kind};
use crate::plant::measurement::recording::root_mean_square;
use crate::plant::{CATALOGUE, Campaign, Motion, NoiseKind, OUTSIDE, Trajectory};

/// The default joint without noise and rounding.
fn quiet() -> Joint {
    let mut joint = Joint::default();
    joint.noise.white_torque_nm = 0.0;
    joint.noise.coloured_torque_nm = 0.0;
    joint.drive.torque_resolution_nm = 0.0;
    joint
}

fn only(motion: Motion) -> Campaign {
    Campaign { trajectories: vec![Trajectory::from(motion)], ..Campaign::default() }
}

/// Torque of the nominal law over every sample in which the joint slides one way all the time.
fn sliding(joint: &Joint, recording: &SimulatedRecording) -> Vec<(usize, f64)> {
    let truth = &recording.truth;
    let load = recording.column("load_torque_Nm").unwrap();
    (0..recording.len() - 1)
        .filter(|&k| truth.velocity[k].abs() > 0.05 && truth.velocity[k] * truth.velocity[k + 1] > 0.0)
        .map(|k| {
            let velocity = 0.5 * (truth.velocity[k] + truth.velocity[k + 1]);
            let friction =
                joint.friction.coulomb_torque_nm * velocity.signum() + joint.friction.viscous_nm_s_rad * velocity;
            let gravity = 0.5 * (load[k] + load[k + 1]);
            (k, joint.inertia_kgm2 * truth.acceleration[k] + gravity + friction)
        })
        .collect()
}

#[test]
fn the_closed_loop_tracks_its_reference() {
    let recording = simulate(&Joint::default(), 3).unwrap();
    let reference = recording.column("reference_position_rad").unwrap();
    let error: Vec<f64> = reference.iter().zip(&recording.truth.position).map(|(r, q)| r - q).collect();
    assert!(root_mean_square(&error) < 1e-3, "{}", root_mean_square(&error));
    assert_eq!(recording.len(), 72_000);
    assert!((recording.truth.noise_rms - 0.375).abs() < 0.01);
}

#[test]
fn one_seed_one_recording() {
    let joint = Joint { campaign: Campaign::default().with_duration(12.0), ..Joint::default() };
    let first = conceal(&joint, "presliding", 0.7, 8).unwrap();
    assert_eq!(first, conceal(&joint, "presliding", 0.7, 8).unwrap());
    assert_ne!(first, conceal(&joint, "presliding", 0.7, 9).unwrap());
    // Hiding something leaves motions, noise and the drawn shape alone.
    let weaker = conceal(&joint, "presliding", 0.1, 8).unwrap();
    assert_eq!(first.column("reference_position_rad"), weaker.column("reference_position_rad"));
    assert_eq!(first.truth.noise_torque, weaker.truth.noise_torque);
    assert_eq!(first.truth.parameters, weaker.truth.parameters);
}

#[test]
fn another_recording_of_a_joint_hides_the_same_effect_under_another_motion() {
    let joint = Joint { campaign: Campaign::default().with_duration(12.0), ..Joint::default() };
    let effects = vec![Hidden { name: "position_ripple".to_owned(), amplitude: 1.0 }];
    let joint = Joint { effects, ..joint };
    let [first, again] = [8, 9].map(|motion_seed| simulate_again(&joint, 8, motion_seed).unwrap());
    assert_eq!(first, simulate(&joint, 8).unwrap());
    assert_eq!(first.truth.parameters, again.truth.parameters);
    let other = simulate(&joint, 9).unwrap();
    assert_eq!(again.column("reference_position_rad"), other.column("reference_position_rad"));
    assert_eq!(again.truth.noise_torque.len(), other.truth.noise_torque.len());
    assert_ne!(again.truth.parameters, other.truth.parameters);
}

#[test]
fn a_clean_joint_obeys_the_nominal_law() {
    let joint = quiet();
    let recording = simulate(&joint, 4).unwrap();
    let torque = recording.column("torque_Nm").unwrap();
    assert!(recording.truth.effect_torque.iter().all(|e| e.abs() < 1e-9));
    for (k, nominal) in sliding(&joint, &recording) {
        assert!((torque[k] - nominal).abs() < 0.02, "row {k}: {} against {nominal}", torque[k]);
    }
}

#[test]
fn the_effect_torque_is_what_the_nominal_law_lacks() {
    let joint = Joint { campaign: Campaign::default().with_duration(36.0), ..quiet() };
    for entry in CATALOGUE.iter().chain(OUTSIDE) {
        if ["quantisation", "unit_or_sign", "clock_gaps"].contains(&entry.name) {
            continue;
        }
        let recording = conceal(&joint, entry.name, 0.7, 6).unwrap();
        let torque = recording.column("torque_Nm").unwrap();
        let rows = sliding(&joint, &recording);
        let wrong: Vec<f64> =
            rows.iter().map(|&(k, nominal)| torque[k] - nominal - recording.truth.effect_torque[k]).collect();
        let error = root_mean_square(&wrong);
        assert!(error < 0.02, "{}: {error}", entry.name);
        assert!(recording.truth.effect_rms() > 0.01, "{}: {}", entry.name, recording.truth.effect_rms());
    }
}

#[test]
fn amplitude_scales_every_torque_and_zero_hides_nothing() {
    let joint = Joint { campaign: Campaign::default().with_duration(24.0), ..Joint::default() };
    let clean = simulate(&joint, 2).unwrap();
    for entry in CATALOGUE.iter().chain(OUTSIDE) {
        let none = conceal(&joint, entry.name, 0.0, 2).unwrap();
        assert_eq!(clean.column("torque_Nm"), none.column("torque_Nm"), "{}", entry.name);
        let rms = |amplitude| conceal(&joint, entry.name, amplitude, 2).unwrap().truth.effect_rms_over(16);
        let (weak, full) = (rms(0.25), rms(0.5));
        if full > 0.0 {
            assert!((0.3..0.7).contains(&(weak / full)), "{}: {weak} to {full}", entry.name);
        }
    }
}

#[test]
fn strong_effects_stay_stable() {
    let joint = Joint { campaign: Campaign::default().with_duration(24.0), ..Joint::default() };
    for entry in CATALOGUE.iter().chain(OUTSIDE) {
        for seed in 0..3 {
            let recording = conceal(&joint, entry.name, 2.5, seed).unwrap();
            assert!(recording.columns.iter().all(|column| column.values.iter().all(|x| x.is_finite())));
        }
    }
}

#[test]
fn stiction_neither_creeps_nor_chatters() {
    let dwells_s = vec![0.3, 0.6];
    let motion = Motion::StopAndGo { step_rad: 0.3, speed_rad_s: 0.8, dwells_s };
    let mut joint = Joint { campaign: only(motion), ..Joint::default() };
    joint.friction.stribeck_torque_nm = 1.0;
    let recording = simulate(&joint, 1).unwrap();
    let velocity = &recording.truth.velocity;
    let at_rest = velocity.iter().filter(|v| **v == 0.0).count() as f64 / velocity.len() as f64;
    assert!(at_rest > 0.3, "{at_rest}");
    let starts = velocity.windows(2).filter(|pair| pair[0] == 0.0 && pair[1] != 0.0).count();
    assert!(starts < 120, "{starts} starts in six seconds");
}

#[test]
fn halving_the_step_changes_nothing_that_a_sensor_could_see() {
    let campaign = only(Motion::Triangles { amplitude_rad: 0.4, speed_rad_s: 1.0 });
    let coarse = Joint { campaign, ..quiet() };
    let mut fine = coarse.clone();
    fine.drive.steps_per_sample = 16;
    for effect in ["elasticity", "presliding", "load_friction"] {
        let torque = |joint| conceal(joint, effect, 1.0, 5).unwrap().column("torque_Nm").unwrap().to_vec();
        let difference: Vec<f64> = torque(&coarse).iter().zip(torque(&fine)).map(|(a, b)| a - b).collect();
        assert!(root_mean_square(&difference) < 0.05, "{effect}: {}", root_mean_square(&difference));
    }
}

#[test]
fn every_kind_of_control_is_free_of_effects() {
    for kind in NoiseKind::ALL {
        let mut joint = Joint { campaign: Campaign::default().with_duration(12.0), ..Joint::default() };
        joint.noise.kind = kind;
        let recording = simulate(&joint, 1).unwrap();
        assert!(recording.truth.effect_rms() < 1e-9, "{kind:?}");
    }
}

#[test]
fn the_joint_cools_in_an_unrecorded_rest() {
    let joint = Joint { campaign: Campaign::default().with_cooling(120.0), ..Joint::default() };
    let recording = simulate(&joint, 1).unwrap();
    let (time, temperature) = (recording.column("time_s").unwrap(), recording.column("temperature_C").unwrap());
    let gap = (1..time.len()).max_by(|&a, &b| (time[a] - time[a - 1]).total_cmp(&(time[b] - time[b - 1]))).unwrap();
    assert!((time[gap] - time[gap - 1] - 120.001).abs() < 1e-6);
    assert!(temperature[gap + 5] < temperature[gap - 5] - 0.5);
}

#[test]
fn bad_values_are_named() {
    let joint = Joint { inertia_kgm2: -1.0, ..Joint::default() };
    assert!(matches!(simulate(&joint, 1), Err(PlantError::OutOfRange { key: "inertia_kgm2", .. })));
    assert!(matches!(conceal(&Joint::default(), "magnetism", 1.0, 1), Err(PlantError::UnknownEffect(_))));
    let mut joint = Joint::default();
    joint.effects.push(Hidden { name: "elasticity".into(), amplitude: 1.0 });
    assert!(matches!(conceal(&joint, "backlash", 1.0, 1), Err(PlantError::TwoTransmissions(_))));
}

#[test]
fn a_drive_without_torque_sensor_writes_down_what_it_is_told() {
    let servo = Actuator {
        gain: 2.0,
        supply: 24.0,
        error_gain: 0.05,
        kp: 20.0,
        back_emf: 0.5,
        ..Actuator::ideal(Kind::PositionServo)
    };
    let of = |actuator: Actuator| simulate(&Joint { actuator: Some(actuator), ..Joint::default() }, 1).unwrap();
    let tracks = |recording: &SimulatedRecording| {
        let [position, reference] =
            ["position_rad", "reference_position_rad"].map(|name| recording.column(name).unwrap());
        let error: f64 = position.iter().zip(reference).map(|(q, r)| (q - r).powi(2)).sum();
        (error / position.len() as f64).sqrt() < 0.3
    };
    for (kind, told) in [
        (Kind::Pd, Some("reference_velocity_rad_s")),
        (Kind::PositionServo, None),
        (Kind::Current, Some("current_A")),
        (Kind::DcMotor, Some("duty")),
    ] {
        let actuator = if kind == Kind::Pd {
            Actuator { kp: 400.0, kd: 20.0, ..Actuator::ideal(kind) }
        } else {
            Actuator { kind, ..servo }
        };
        let recording = of(actuator);
        assert!(recording.column("torque_Nm").is_none() && recording.column("load_torque_Nm").is_none());
        assert!(told.is_none_or(|name| recording.column(name).is_some_and(|values| values.iter().any(|v| *v != 0.0))));
        assert!(tracks(&recording), "{kind:?}");
    }
}

#[test]
fn a_command_acts_as_late_as_the_actuator_says() {
    let pd = Actuator { kp: 400.0, kd: 20.0, ..Actuator::ideal(Kind::Pd) };
    let joint = |delay_s: f64| Joint { actuator: Some(Actuator { delay_s, ..pd }), ..quiet() };
    let [now, later] = [0.0, 0.02].map(|delay_s| simulate(&joint(delay_s), 1).unwrap());
    let error = |recording: &SimulatedRecording, late: usize| {
        let [position, reference] =
            ["position_rad", "reference_position_rad"].map(|name| recording.column(name).unwrap());
        (late..4000).map(|k| (position[k] - reference[k - late]).powi(2)).sum::<f64>()
    };
    assert!(error(&later, 20) < 2.0 * error(&now, 0), "{} {}", error(&later, 20), error(&now, 0));
    assert!(error(&later, 0) > error(&now, 0));
}
