//! Integrates the closed loop of drive and joint over a campaign, sample by sample.

use super::error::PlantError;
use super::moving::MovingJoint;
use crate::plant::measurement::sensors::History;
use crate::plant::mechanics::control::{Controller, Target};
use crate::plant::mechanics::transmission::Load;
use crate::plant::trajectory::reference::Reference;

/// Beyond this speed the motion is taken to be unstable, rad/s.
const RUNAWAY_RAD_S: f64 = 1e3;

/// Integrates the whole campaign.
///
/// # Errors
/// [`PlantError::Unstable`] where the motion leaves all bounds.
pub(crate) fn integrate(moving: &mut MovingJoint, references: &[(Reference, f64)]) -> Result<History, PlantError> {
    let joint = moving.joint;
    let sample_s = 1.0 / joint.drive.rate_hz;
    let mut controller = Controller::new(joint);
    let mut history = History::default();
    let mut paused = 0.0;
    let mut row = 0;
    for (index, ((reference, gravity_torque), trajectory)) in references.iter().zip(joint.campaign.all()).enumerate() {
        let load = Load::of(joint, *gravity_torque);
        moving.rest(trajectory.pause_before_s, row as f64 / joint.drive.rate_hz + paused, &load);
        paused += trajectory.pause_before_s;
        for k in 0..reference.position.len() {
            let time = row as f64 / joint.drive.rate_hz + paused;
            let reading = moving.reading();
            let target = Target {
                position: reference.position[k],
                velocity: reference.velocity[k],
                acceleration: reference.acceleration[k],
                gravity_torque: *gravity_torque,
            };
            let (command, effort) = controller.command(reading, moving.motor.velocity, &target);
            let applied = moving.actuated(command);
            moving.see_neighbour(time);
            history.time.push(time);
            history.trajectory.push(index as f64);
            history.reference.push(reference.position[k]);
            history.reference_velocity.push(reference.velocity[k]);
            history.effort.push(effort);
            history.encoder.push(reading);
            history.position.push(moving.motor.position);
            history.velocity.push(moving.motor.velocity);
            history.link_position.push(moving.link_position());
            history.torque.push(command);
            history.gravity_torque.push(*gravity_torque);
            history.temperature.push(moving.housing.temperature);
            history.other_position.push(moving.other.position);
            history.other_velocity.push(moving.other.velocity);
            history.other_acceleration.push(moving.other.acceleration);
            let before = moving.motor.velocity;
            let effect = moving.sample(applied, time, &load);
            history.effect_torque.push(effect + command - applied);
            history.acceleration.push((moving.motor.velocity - before) / sample_s);
            if moving.motor.velocity.is_nan() || moving.motor.velocity.abs() > RUNAWAY_RAD_S {
                return Err(PlantError::Unstable(time));
            }
            row += 1;
        }
    }
    Ok(history)
}
