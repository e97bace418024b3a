//! From a joint and a seed to a recording.

use super::concealed::Concealed;
use super::error::{MOST_SAMPLES, PlantError};
use super::integrator::integrate;
use super::joint::{Hidden, Joint};
use super::moving::MovingJoint;
use super::random::{Draws, Purpose};
use crate::plant::measurement::recording::SimulatedRecording;
use crate::plant::measurement::sensors::record;
use crate::plant::trajectory::reference::Reference;

/// Simulates a recording of `joint` with its own hidden effects.
///
/// # Errors
/// [`PlantError`] for a value out of range, an unknown effect, or an unstable motion.
pub fn simulate(joint: &Joint, seed: u64) -> Result<SimulatedRecording, PlantError> {
    simulate_again(joint, seed, seed)
}

/// Another recording of the joint that [`simulate`] has for `seed`: the same hidden effects under motions and noise of `motion_seed`.
///
/// # Errors
/// As [`simulate`].
pub fn simulate_again(joint: &Joint, seed: u64, motion_seed: u64) -> Result<SimulatedRecording, PlantError> {
    let (mut moving, mut followed) = with_references(joint, seed)?;
    if motion_seed != seed {
        followed = references(joint, motion_seed);
    }
    let history = integrate(&mut moving, &followed)?;
    Ok(record(joint, history, &moving.hidden.faults, moving.hidden.parameters, motion_seed))
}

/// Simulates with one more effect hidden at `amplitude`; motions, noise and the shape of the effect depend on the seed
/// alone, so that the amplitude can be scaled in a second pass.
///
/// # Errors
/// As [`simulate`].
pub fn conceal(joint: &Joint, name: &str, amplitude: f64, seed: u64) -> Result<SimulatedRecording, PlantError> {
    let mut joint = joint.clone();
    joint.effects.push(Hidden { name: name.to_owned(), amplitude });
    simulate(&joint, seed)
}

/// `joint` at rest, with the effects that [`simulate`] hides in it for the same seed.
///
/// # Errors
/// As [`simulate`], but for an unstable motion.
pub(crate) fn at_rest(joint: &Joint, seed: u64) -> Result<MovingJoint<'_>, PlantError> {
    with_references(joint, seed).map(|(moving, _)| moving)
}

/// A reference, and its gravity torque, N m.
type Trajectory = (Reference, f64);

/// The joint at rest, and the references of its own seed: effects are drawn for their range.
fn with_references(joint: &Joint, seed: u64) -> Result<(MovingJoint<'_>, Vec<Trajectory>), PlantError> {
    validate(joint)?;
    let references = references(joint, seed);
    let hidden = Concealed::draw(joint, &references, seed)?;
    Ok((MovingJoint::new(joint, hidden, seed), references))
}

fn validate(joint: &Joint) -> Result<(), PlantError> {
    let positive = [
        ("inertia_kgm2", joint.inertia_kgm2),
        ("friction.stribeck_velocity_rad_s", joint.friction.stribeck_velocity_rad_s),
        ("friction.stribeck_exponent", joint.friction.stribeck_exponent),
        ("control.bandwidth_Hz", joint.control.bandwidth_hz),
        ("control.damping_ratio", joint.control.damping_ratio),
        ("control.velocity_corner_Hz", joint.control.velocity_corner_hz),
        ("drive.rate_Hz", joint.drive.rate_hz),
        ("drive.steps_per_sample", joint.drive.steps_per_sample as f64),
        ("drive.counts_per_turn", joint.drive.counts_per_turn),
        ("drive.gear_ratio", joint.drive.gear_ratio),
        ("noise.correlation_time_s", joint.noise.correlation_time_s),
        ("thermal.time_constant_s", joint.thermal.time_constant_s),
        ("campaign.trajectory_s", joint.campaign.trajectory_s),
    ];
    for (key, value) in positive {
        if !(value.is_finite() && value > 0.0) {
            return Err(PlantError::OutOfRange { key, range: "positive and finite", value });
        }
    }
    let not_negative = [
        ("friction.coulomb_torque_Nm", joint.friction.coulomb_torque_nm),
        ("friction.viscous_Nm_s_rad", joint.friction.viscous_nm_s_rad),
        ("friction.contact_stiffness_Nm_rad", joint.friction.contact_stiffness_nm_rad),
        ("drive.torque_resolution_Nm", joint.drive.torque_resolution_nm),
        ("drive.torque_limit_Nm", joint.drive.torque_limit_nm),
        ("noise.white_torque_Nm", joint.noise.white_torque_nm),
        ("noise.coloured_torque_Nm", joint.noise.coloured_torque_nm),
    ];
    for (key, value) in not_negative.into_iter().chain(joint.friction.load_shares()) {
        if !(value.is_finite() && value >= 0.0) {
            return Err(PlantError::OutOfRange { key, range: "zero or positive, and finite", value });
        }
    }
    let share = joint.motor_inertia_share;
    if !(share > 0.0 && share < 1.0) {
        return Err(PlantError::OutOfRange { key: "motor_inertia_share", range: "between 0 and 1", value: share });
    }
    refuse_length(joint.campaign.duration_s(), joint.drive.rate_hz)
}

/// Refuses a recording of `duration_s` seconds at `rate_hz` that is longer than a simulation may be, before anything is asked for it.
///
/// # Errors
/// [`PlantError::TooLong`].
pub fn refuse_length(duration_s: f64, rate_hz: f64) -> Result<(), PlantError> {
    let samples = duration_s * rate_hz;
    if samples <= MOST_SAMPLES { Ok(()) } else { Err(PlantError::TooLong(samples)) }
}

/// The reference of every trajectory, with its gravity torque.
fn references(joint: &Joint, seed: u64) -> Vec<Trajectory> {
    let campaign = &joint.campaign;
    campaign
        .all()
        .enumerate()
        .map(|(index, trajectory)| {
            let mut draws = Draws::new(seed, Purpose::Motion, 1000 * (index as u64 + 1));
            let duration = trajectory.duration_s.unwrap_or(campaign.trajectory_s);
            let reference = trajectory.motion.reference(duration, joint.drive.rate_hz, &mut draws);
            let payloads = &joint.gravity_torque_nm;
            let in_turn = if payloads.is_empty() { 0.0 } else { payloads[index % payloads.len()] };
            (reference, trajectory.gravity_torque_nm.unwrap_or(in_turn))
        })
        .collect()
}

#[cfg(test)]
mod tests;
