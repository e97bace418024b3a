//! Signatures: each effect is where its physics says it is, and nowhere else.

use crate::plant::measurement::recording::root_mean_square;
use crate::plant::{Campaign, Joint, Motion, OUTSIDE, SimulatedRecording, Trajectory, conceal};

/// The default joint without noise and rounding.
fn quiet() -> Joint {
    let mut joint = Joint::default();
    joint.noise.white_torque_nm = 0.0;
    joint.noise.coloured_torque_nm = 0.0;
    joint.drive.torque_resolution_nm = 0.0;
    joint
}

fn hide(name: &str, seed: u64) -> SimulatedRecording {
    conceal(&quiet(), name, 1.0, seed).unwrap()
}

fn parameter(recording: &SimulatedRecording, name: &str) -> f64 {
    recording.truth.parameters.iter().find(|(key, _)| key == name).unwrap_or_else(|| panic!("{name}")).1
}

/// Root mean square of the effect torque over the rows that `select` keeps.
fn strength(recording: &SimulatedRecording, select: impl Fn(usize) -> bool) -> f64 {
    let effect = &recording.truth.effect_torque;
    let kept: Vec<f64> = (0..effect.len()).filter(|&k| select(k)).map(|k| effect[k]).collect();
    assert!(kept.len() > 50, "only {} rows", kept.len());
    root_mean_square(&kept)
}

/// Correlation of the effect torque with a regressor over the moving rows.
fn correlation(recording: &SimulatedRecording, regressor: impl Fn(usize) -> f64) -> f64 {
    let truth = &recording.truth;
    let (mut xy, mut xx, mut yy) = (0.0, 0.0, 0.0);
    for k in (0..recording.len()).filter(|&k| truth.velocity[k].abs() > 0.02) {
        let (x, y) = (regressor(k), truth.effect_torque[k]);
        xy += x * y;
        xx += x * x;
        yy += y * y;
    }
    xy / (xx * yy).sqrt()
}

#[test]
fn stribeck_lives_at_low_speed() {
    let recording = hide("stribeck", 1);
    let speed = |k: usize| recording.truth.velocity[k].abs();
    assert!(strength(&recording, |k| speed(k) > 1e-4 && speed(k) < 0.02) > 0.4);
    assert!(strength(&recording, |k| speed(k) > 1.5) < 0.05);
}

#[test]
fn viscous_nonlinearity_follows_a_power_of_speed() {
    let recording = hide("viscous_nonlinearity", 2);
    let exponent = parameter(&recording, "viscous_nonlinearity.exponent");
    let velocity = &recording.truth.velocity;
    assert!(correlation(&recording, |k| velocity[k].signum() * velocity[k].abs().powf(exponent)) > 0.999);
}

#[test]
fn direction_asymmetry_is_even_in_velocity() {
    let recording = hide("direction_asymmetry", 1);
    let (effect, velocity) = (&recording.truth.effect_torque, &recording.truth.velocity);
    let mean = |sign: f64| {
        let kept: Vec<f64> = (0..effect.len()).filter(|&k| sign * velocity[k] > 0.1).map(|k| effect[k]).collect();
        kept.iter().sum::<f64>() / kept.len() as f64
    };
    assert!(mean(1.0).abs() > 0.15 && (mean(1.0) / mean(-1.0) - 1.0).abs() < 0.2, "{} {}", mean(1.0), mean(-1.0));
}

#[test]
fn slow_effects_follow_their_channel() {
    let velocity = |recording: &SimulatedRecording, k: usize| recording.truth.velocity[k];
    let warm = hide("temperature", 1);
    let rise = |k: usize| warm.column("temperature_C").unwrap()[k] - 25.0;
    assert!(correlation(&warm, |k| rise(k) * velocity(&warm, k)) < -0.8);
    let drift = hide("slow_drift", 1);
    let time = drift.column("time_s").unwrap();
    assert!(correlation(&drift, |k| time[k] * velocity(&drift, k).signum()).abs() > 0.95);
    let load = hide("load_friction", 1);
    let torque = load.column("load_torque_Nm").unwrap();
    assert!(correlation(&load, |k| torque[k].abs() * velocity(&load, k).signum()) > 0.95);
}

#[test]
fn a_driven_gear_loses_more_than_a_backdriven_one() {
    let recording = hide("drive_backdrive", 1);
    let load = recording.column("load_torque_Nm").unwrap();
    let velocity = &recording.truth.velocity;
    let side = |sign: f64| strength(&recording, |k| sign * load[k] * velocity[k] > 0.5);
    assert!(side(1.0) > 1.5 * side(-1.0), "{} {}", side(1.0), side(-1.0));
}

#[test]
fn warm_up_recovers_in_a_rest() {
    let joint = Joint { campaign: Campaign::default().with_cooling(600.0), ..quiet() };
    let recording = conceal(&joint, "warm_up", 1.0, 3).unwrap();
    let time = recording.column("time_s").unwrap();
    let speed = |k: usize| recording.truth.velocity[k].abs();
    let relative = |from: f64, to: f64| strength(&recording, |k| (from..to).contains(&time[k]) && speed(k) > 0.3);
    assert!(relative(636.0, 638.0) < 0.6 * relative(30.0, 36.0));
}

#[test]
fn presliding_is_over_after_a_distance_from_the_reversal() {
    for seed in 1..5 {
        let recording = hide("presliding", seed);
        let (position, velocity) = (&recording.truth.position, &recording.truth.velocity);
        let mut turn = position[0];
        let mut direction = 0.0;
        let distance: Vec<f64> = (0..recording.len())
            .map(|k| {
                if velocity[k] * direction < 0.0 {
                    turn = position[k];
                }
                if velocity[k] != 0.0 {
                    direction = velocity[k].signum();
                }
                (position[k] - turn).abs()
            })
            .collect();
        let moving = |k: usize| velocity[k].abs() > 0.01;
        let near = strength(&recording, |k| moving(k) && distance[k] < 1e-3);
        let far = strength(&recording, |k| moving(k) && distance[k] > 0.15);
        assert!(near > 0.5 && far < 0.15 * near, "seed {seed}: {near} near, {far} far");
    }
}

#[test]
fn lag_makes_friction_higher_while_slowing_down() {
    let recording = hide("frictional_lag", 2);
    let (velocity, acceleration) = (&recording.truth.velocity, &recording.truth.acceleration);
    assert!(correlation(&recording, |k| acceleration[k] * (velocity[k].abs() < 0.3) as u8 as f64) < -0.3);
}

#[test]
fn breakaway_grows_with_the_stop_before_it() {
    let start_after = |dwell: f64| {
        let motion = Motion::StopAndGo { step_rad: 0.3, speed_rad_s: 0.8, dwells_s: vec![dwell] };
        let campaign = Campaign { trajectories: vec![Trajectory::from(motion)], ..Campaign::default() };
        let recording = conceal(&Joint { campaign, ..quiet() }, "dwell_breakaway", 1.0, 1).unwrap();
        recording.truth.effect_torque[2000..4000].iter().fold(0.0_f64, |peak, e| peak.max(e.abs()))
    };
    assert!(start_after(1.2) > start_after(0.1) + 0.2, "{} {}", start_after(1.2), start_after(0.1));
}

#[test]
fn ripple_repeats_with_position() {
    for seed in 1..6 {
        let recording = hide("position_ripple", seed);
        let order = parameter(&recording, "position_ripple.order");
        let dry = parameter(&recording, "position_ripple.friction_type") == 1.0;
        let truth = &recording.truth;
        let sign = |k: usize| if dry { truth.velocity[k].signum() } else { 1.0 };
        let angle = |k: usize| order * (truth.position[k] + 0.0005 * truth.velocity[k]);
        let cosine = correlation(&recording, |k| sign(k) * angle(k).cos());
        let sine = correlation(&recording, |k| sign(k) * angle(k).sin());
        assert!(cosine.hypot(sine) > 0.6, "seed {seed}: {cosine} {sine} at order {order}");
    }
}

#[test]
fn kinematic_error_grows_with_speed() {
    let recording = hide("kinematic_error", 1);
    let speed = |k: usize| recording.truth.velocity[k].abs();
    let slow = strength(&recording, |k| (0.2..0.4).contains(&speed(k)));
    let fast = strength(&recording, |k| (1.6..2.4).contains(&speed(k)));
    assert!(fast > 5.0 * slow, "{slow} {fast}");
}

#[test]
fn rigid_body_and_torque_chain_follow_their_regressors() {
    let inertia = hide("inertia_error", 1);
    assert!(correlation(&inertia, |k| inertia.truth.acceleration[k]).abs() > 0.999);
    let scale = hide("torque_scale", 1);
    let torque = scale.column("torque_Nm").unwrap();
    assert!(correlation(&scale, |k| torque[k]).abs() > 0.999);
    let spring = hide("spring", 1);
    let rest = parameter(&spring, "spring.rest_position_rad");
    assert!(correlation(&spring, |k| spring.truth.position[k] - rest) > 0.999);
    let gravity = hide("gravity_error", 1);
    let (sine, cosine) = (parameter(&gravity, "gravity_error.sine_Nm"), parameter(&gravity, "gravity_error.cosine_Nm"));
    let position = &gravity.truth.position;
    assert!(correlation(&gravity, |k| sine * position[k].sin() + cosine * position[k].cos()) > 0.999);
    let offset = hide("torque_offset", 1);
    let constant = parameter(&offset, "torque_offset.offset_Nm");
    assert!(offset.truth.effect_torque.iter().all(|e| (e - constant).abs() < 1e-9));
}

#[test]
fn coupling_acts_while_this_joint_rests() {
    let campaign = Campaign { trajectories: vec![Trajectory::from(Motion::Rest)], ..Campaign::default() };
    let recording = conceal(&Joint { campaign, ..quiet() }, "coupling", 1.0, 1).unwrap();
    assert!(recording.truth.velocity.iter().all(|v| *v == 0.0));
    assert!(recording.truth.effect_rms() > 0.05);
}

#[test]
fn saturation_needs_a_large_torque() {
    let recording = hide("saturation", 1);
    let threshold = parameter(&recording, "saturation.threshold_Nm");
    let torque = recording.column("torque_Nm").unwrap();
    assert!(strength(&recording, |k| torque[k].abs() <= threshold) < 1e-9);
    assert!(strength(&recording, |k| torque[k].abs() > threshold + 1.0) > 0.4);
}

#[test]
fn contact_is_one_sided() {
    let recording = hide("contact", 1);
    let stop = parameter(&recording, "contact.stop_rad");
    let beyond = |k: usize| stop.signum() * recording.truth.position[k] - stop.abs();
    assert!(strength(&recording, |k| beyond(k) < -0.01) < 1e-9);
    assert!(strength(&recording, |k| beyond(k) > 0.05) > 0.2);
}

#[test]
fn an_event_is_bounded_in_time_and_a_fault_in_angle() {
    let event = hide("transient_event", 1);
    let start = parameter(&event, "transient_event.start_s");
    let end = start + parameter(&event, "transient_event.length_s");
    let time = event.column("time_s").unwrap();
    assert!(strength(&event, |k| time[k] < start - 0.002 || time[k] > end + 0.002) < 1e-9);
    assert!(strength(&event, |k| (start..end).contains(&time[k])) > 0.5);
    let fault = hide("recurrent_fault", 1);
    let quiet_rows = fault.truth.effect_torque.iter().filter(|e| e.abs() < 0.05).count();
    assert!(quiet_rows > fault.len() / 2 && fault.truth.effect_rms() > 0.05);
}

#[test]
fn a_second_encoder_sees_what_the_gear_does() {
    let joint = Joint { link_encoder: true, ..quiet() };
    let twist = |name: &str| {
        let recording = conceal(&joint, name, 1.0, 1).unwrap();
        let link = recording.column("link_position_rad").unwrap();
        let twist: Vec<f64> = recording.truth.position.iter().zip(link).map(|(a, b)| a - b).collect();
        let load: Vec<f64> = recording.column("load_torque_Nm").unwrap().to_vec();
        (recording, twist, load)
    };
    let (gap, twisted, load) = twist("backlash");
    let half = parameter(&gap, "backlash.half_gap_rad");
    let mut pressed: Vec<f64> = (0..gap.len()).filter(|&k| load[k] > 2.0).map(|k| twisted[k]).collect();
    pressed.sort_by(f64::total_cmp);
    let usual = pressed[pressed.len() / 2];
    assert!(usual > half && usual < 1.2 * half, "{usual} against {half}");
    let (elastic, twisted, load) = twist("elasticity");
    let stiffness = parameter(&elastic, "elasticity.stiffness_Nm_rad");
    let slow: Vec<usize> = (0..elastic.len()).filter(|&k| elastic.truth.acceleration[k].abs() < 0.2).collect();
    let error: Vec<f64> = slow.iter().map(|&k| stiffness * twisted[k] - load[k]).collect();
    assert!(root_mean_square(&error) < 0.5, "{}", root_mean_square(&error));
    let (wave, twisted, _) = twist("kinematic_error");
    let size = parameter(&wave, "kinematic_error.error_rad");
    assert!(twisted.iter().all(|x| x.abs() < 1.5 * size) && root_mean_square(&twisted) > 0.5 * size);
}

#[test]
fn measurement_faults_are_in_the_columns() {
    let delayed = hide("time_misalignment", 1);
    let delay = (parameter(&delayed, "time_misalignment.delay_s") * 1000.0).round() as i64;
    let clean = crate::plant::simulate(&quiet(), 1).unwrap();
    let (late, prompt) = (delayed.column("torque_Nm").unwrap(), clean.column("torque_Nm").unwrap());
    let error: Vec<f64> = (100..70_000).map(|k| late[k] - prompt[(k as i64 - delay) as usize]).collect();
    assert!(root_mean_square(&error) < 0.5 * delayed.truth.effect_rms());
    let seeds = 1..8;
    assert!(seeds.clone().any(|seed| {
        let mut values = hide("quantisation", seed).column("position_rad").unwrap().to_vec();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values.len() < 20_000
    }));
    assert!(seeds.clone().any(|seed| {
        let recording = hide("unit_or_sign", seed);
        let work: f64 =
            (0..recording.len()).map(|k| recording.column("torque_Nm").unwrap()[k] * recording.truth.velocity[k]).sum();
        work < 0.0
    }));
    let gaps = hide("clock_gaps", 1);
    let longest = gaps.column("time_s").unwrap().windows(2).map(|t| t[1] - t[0]).fold(0.0, f64::max);
    assert!(longest > 0.009 && gaps.len() < 72_000);
    assert_eq!(gaps.truth.velocity.len(), gaps.len());
}

#[test]
fn at_least_twelve_structures_have_no_name() {
    assert!(OUTSIDE.len() >= 12);
    for entry in OUTSIDE {
        assert!(entry.name.starts_with("unknown_") && !entry.channels.is_empty());
        let recording = hide(entry.name, 1);
        assert!(recording.truth.effect_rms() > 0.02, "{}: {}", entry.name, recording.truth.effect_rms());
    }
}
