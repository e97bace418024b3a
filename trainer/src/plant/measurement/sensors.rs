//! From the truth to the columns: encoder, torque signal, temperature, and what can go wrong in the measurement chain.

use super::noise::torque_noise;
use super::recording::{Column, SimulatedRecording, Truth, root_mean_square};
use crate::actuator::Kind;
use crate::plant::joint::{Joint, LoadChannel, NoiseKind};
use crate::plant::mechanics::control::round_to;
use crate::plant::random::{Draws, Purpose};
use std::f64::consts::TAU;

/// A fault between the joint and the file.
pub(crate) enum SensorFault {
    /// Constant added to the torque, N m.
    TorqueOffset(f64),
    /// The torque column lags the others by this time, s (negative: leads).
    TorqueDelay(f64),
    /// Coarse step of the recorded position, rad.
    PositionStep(f64),
    /// Coarse step of the recorded torque, N m.
    TorqueStep(f64),
    /// The torque column is multiplied by this (a sign or a unit).
    TorqueFactor(f64),
    /// The position column is multiplied by this.
    PositionFactor(f64),
    /// Samples lost after the fraction `.0` of the recording, for `.1` seconds.
    LostSamples(Vec<(f64, f64)>),
}

/// The true history, one value a sample.
#[derive(Default)]
pub(crate) struct History {
    pub(crate) time: Vec<f64>,
    pub(crate) trajectory: Vec<f64>,
    pub(crate) reference: Vec<f64>,
    pub(crate) reference_velocity: Vec<f64>,
    /// What the drive writes down as commanded: current in A or duty of an actuator that is told these.
    pub(crate) effort: Vec<f64>,
    pub(crate) encoder: Vec<f64>,
    pub(crate) position: Vec<f64>,
    pub(crate) velocity: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
    pub(crate) link_position: Vec<f64>,
    pub(crate) torque: Vec<f64>,
    pub(crate) effect_torque: Vec<f64>,
    pub(crate) gravity_torque: Vec<f64>,
    pub(crate) temperature: Vec<f64>,
    pub(crate) other_position: Vec<f64>,
    pub(crate) other_velocity: Vec<f64>,
    pub(crate) other_acceleration: Vec<f64>,
}

/// Step of the encoder, rad.
pub(crate) fn encoder_step(joint: &Joint) -> f64 {
    let counts = match joint.noise.kind {
        NoiseKind::CoarseEncoder => 131_072.0,
        _ => joint.drive.counts_per_turn,
    };
    TAU / counts
}

/// Writes down what the drive saw.
pub(crate) fn record(
    joint: &Joint,
    history: History,
    faults: &[SensorFault],
    parameters: Vec<(String, f64)>,
    seed: u64,
) -> SimulatedRecording {
    let mut torque = history.torque.clone();
    for fault in faults {
        distort_torque(&mut torque, fault, joint.drive.rate_hz);
    }
    let mut effect = history.effect_torque;
    for (effect, (recorded, true_torque)) in effect.iter_mut().zip(torque.iter().zip(&history.torque)) {
        *effect += recorded - true_torque;
    }
    let noise = torque_noise(joint, &history.velocity, &history.acceleration, &history.torque, seed);
    let mut recorded: Vec<f64> =
        torque.iter().zip(&noise).map(|(t, n)| round_to(t + n, joint.drive.torque_resolution_nm)).collect();
    let mut position = history.encoder.clone();
    for fault in faults {
        match fault {
            SensorFault::PositionStep(step) => position.iter_mut().for_each(|p| *p = round_to(*p, *step)),
            SensorFault::TorqueStep(step) => recorded.iter_mut().for_each(|t| *t = round_to(*t, *step)),
            SensorFault::PositionFactor(factor) => position.iter_mut().for_each(|p| *p *= factor),
            SensorFault::TorqueFactor(factor) => recorded.iter_mut().for_each(|t| *t *= factor),
            _ => {}
        }
    }
    let mut columns =
        vec![Column { name: "time_s", values: history.time }, Column { name: "position_rad", values: position }];
    match joint.actuator.map(|actuator| actuator.kind) {
        None | Some(Kind::Torque) => columns.push(Column { name: "torque_Nm", values: recorded }),
        Some(Kind::Current) => columns.push(Column { name: "current_A", values: history.effort }),
        Some(Kind::DcMotor) => columns.push(Column { name: "duty", values: history.effort }),
        Some(Kind::Pd) => columns.push(Column { name: "reference_velocity_rad_s", values: history.reference_velocity }),
        Some(Kind::PositionServo) => {}
    }
    if joint.load_channel == LoadChannel::NominalGravity && joint.actuator.is_none() {
        let phase = joint.gravity_phase_rad;
        let load = history.encoder.iter().zip(&history.gravity_torque).map(|(q, g)| g * (q + phase).sin()).collect();
        columns.push(Column { name: "load_torque_Nm", values: load });
    }
    if joint.thermal.sensor {
        columns.push(Column { name: "temperature_C", values: thermometer(joint, &history.temperature, seed) });
    }
    columns.push(Column { name: "reference_position_rad", values: history.reference });
    if joint.link_encoder {
        let step = encoder_step(joint);
        let link = history.link_position.iter().map(|q| round_to(*q, step)).collect();
        columns.push(Column { name: "link_position_rad", values: link });
    }
    if joint.other_joint.recorded {
        columns.push(Column { name: "other_position_rad", values: history.other_position });
        columns.push(Column { name: "other_velocity_rad_s", values: history.other_velocity });
        columns.push(Column { name: "other_acceleration_rad_s2", values: history.other_acceleration });
    }
    columns.push(Column { name: "trajectory", values: history.trajectory });
    let mut truth = Truth {
        effect_torque: effect,
        noise_torque: noise,
        noise_rms: 0.0,
        position: history.position,
        velocity: history.velocity,
        acceleration: history.acceleration,
        parameters,
    };
    for fault in faults {
        if let SensorFault::LostSamples(gaps) = fault {
            lose_samples(&mut columns, &mut truth, gaps, joint.drive.rate_hz);
        }
    }
    truth.noise_rms = root_mean_square(&truth.noise_torque);
    SimulatedRecording { columns, truth }
}

fn distort_torque(torque: &mut [f64], fault: &SensorFault, rate: f64) {
    match fault {
        SensorFault::TorqueOffset(offset) => torque.iter_mut().for_each(|t| *t += offset),
        SensorFault::TorqueDelay(delay) => {
            // The torque is held over a sample: its delayed mean over a sample is a mix of two neighbours.
            let source = torque.to_vec();
            let last = source.len().saturating_sub(1) as f64;
            for (k, value) in torque.iter_mut().enumerate() {
                let place = (k as f64 - delay * rate).clamp(0.0, last);
                let low = place.floor();
                let high = (low + 1.0).min(last);
                *value = source[low as usize] + (place - low) * (source[high as usize] - source[low as usize]);
            }
        }
        _ => {}
    }
}

fn thermometer(joint: &Joint, temperature: &[f64], seed: u64) -> Vec<f64> {
    let mut draws = Draws::new(seed, Purpose::Channels, 1);
    let thermal = &joint.thermal;
    temperature
        .iter()
        .map(|t| round_to(t + thermal.sensor_noise_k * draws.normal(), thermal.sensor_resolution_k))
        .collect()
}

fn lose_samples(columns: &mut [Column], truth: &mut Truth, gaps: &[(f64, f64)], rate: f64) {
    let count = truth.position.len();
    let lost = |k: usize| {
        gaps.iter().any(|&(place, length)| {
            let start = (place * count as f64) as usize;
            k >= start && k < start + (length * rate) as usize
        })
    };
    let keep: Vec<bool> = (0..count).map(|k| !lost(k)).collect();
    let thin = |values: &mut Vec<f64>| {
        let mut flags = keep.iter();
        values.retain(|_| *flags.next().unwrap_or(&true));
    };
    columns.iter_mut().for_each(|column| thin(&mut column.values));
    [
        &mut truth.effect_torque,
        &mut truth.noise_torque,
        &mut truth.position,
        &mut truth.velocity,
        &mut truth.acceleration,
    ]
    .into_iter()
    .for_each(thin);
}
