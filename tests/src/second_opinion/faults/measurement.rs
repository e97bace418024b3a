//! A torque that is late, a torque in coarse steps, a wrong unit or sign.

use crate::second_opinion::protocol::{Protocol, VELOCITY_NOISE};
use crate::second_opinion::random::{Random, factor};
use crate::second_opinion::recording::Material;

/// Fine steps of a sample.
const STEP: usize = 8;
/// Delays in samples.
const DELAYS: [f64; 6] = [3.0, 5.0, 1.0, 2.0, 2.5, 0.5];

/// The torque is recorded later than the motion.
pub(super) fn late_torque(way: usize, protocol: &Protocol, random: &mut Random) -> Material {
    let fine = protocol.oversampled(STEP, random);
    let steps = (DELAYS[way] * factor(random) * STEP as f64).round() as usize;
    let torque = Protocol::torque(&fine.joint, &fine.path);
    let late: Vec<f64> = (0..torque.len()).map(|i| torque[i.saturating_sub(steps)]).collect();
    let samples = steps as f64 / STEP as f64;
    let note = format!("torque late by {samples:.2} samples, {:.2} ms", 1e3 * samples / protocol.rate_hz);
    protocol.material(&fine.joint, &fine.sampled(), fine.samples_of(&late), &note, random)
}

/// Steps of the torque, Coulomb frictions.
const STEPS: [f64; 6] = [0.1, 0.3, 0.5, 1.0, 0.2, 0.4];

/// The torque is recorded in coarse steps.
pub(super) fn coarse_torque(way: usize, protocol: &Protocol, random: &mut Random) -> Material {
    let fine = protocol.fine(random);
    let path = fine.sampled();
    let step = STEPS[way] * factor(random) * fine.joint.coulomb;
    let mut torque = Protocol::torque(&fine.joint, &path);
    protocol.disturb(&mut torque, random);
    let coarse = torque.iter().map(|torque| (torque / step).round() * step).collect();
    let real = Protocol::columns(&fine.joint, &path, coarse, VELOCITY_NOISE, random);
    protocol.of(&fine.joint, real, &format!("torque in steps of {step:.3}"))
}

/// Column, factor and what happened; the column is written without its unit.
const WRONG: [(&str, f64, &str); 6] = [
    ("velocity", DEGREES, "velocity in deg/s under the name of rad/s"),
    ("torque", -1.0, "torque of the wrong sign"),
    ("torque", 1000.0, "torque in mN m under the name of N m"),
    ("velocity", 1000.0, "velocity in mm/s under the name of m/s"),
    ("position", DEGREES, "position in deg under the name of rad"),
    ("velocity", -1.0, "velocity of the wrong sign"),
];
const DEGREES: f64 = 180.0 / std::f64::consts::PI;

/// One column is not what its name says.
pub(super) fn wrong_unit(way: usize, protocol: &Protocol, random: &mut Random) -> Material {
    let fine = protocol.fine(random);
    let path = fine.sampled();
    let mut torque = Protocol::torque(&fine.joint, &path);
    protocol.disturb(&mut torque, random);
    let mut real = Protocol::columns(&fine.joint, &path, torque, VELOCITY_NOISE, random);
    let (quantity, times, note) = WRONG[way];
    let name = match quantity {
        "torque" => fine.joint.actuator().to_owned(),
        "velocity" => format!("velocity_{}_s", fine.joint.unit()),
        _ => format!("{quantity}_{}", fine.joint.unit()),
    };
    real.scale(&name, times);
    protocol.of(&fine.joint, real, note)
}
