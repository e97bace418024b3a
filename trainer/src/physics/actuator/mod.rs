//! H6 to H9: what the actuator of a joint without torque sensor does otherwise than its constants say. The torque that is compared is what it
//! would have made of its commands by these (the law of `crate::actuator`); an effect is what it makes less by others.

mod dead_band;
mod delay;
mod gain;
mod limit;

use super::JointState;
use crate::actuator::{Actuator, Applied, Command, Commanded, Kind, Motion};

pub(super) use dead_band::DeadBand;
pub(super) use delay::CommandDelay;
pub(super) use gain::ActuatorGain;
pub(super) use limit::SupplyOrDutyLimit;

/// Motion at a sample.
fn motion(state: &JointState, i: usize) -> Motion {
    Motion { position: state.position[i], velocity: state.velocity[i] }
}

/// Torque that the recorded commands make by the constants compared with, less what they make otherwise.
fn missing_torque(state: &JointState, otherwise: impl Fn(&Commanded) -> Commanded) -> Vec<f64> {
    let Some(commanded) = &state.commanded else { return vec![0.0; state.len()] };
    let torque = |commanded: &Commanded| commanded.torque(|i| motion(state, i));
    let mut missing = torque(commanded);
    missing.iter_mut().zip(torque(&otherwise(commanded))).for_each(|(missing, torque)| *missing -= torque);
    missing
}

/// Torque by the gain of an actuator: on a position error, a current, a duty.
fn by_gain(actuator: &Actuator, command: &Command, applied: &Applied) -> f64 {
    match actuator.kind {
        Kind::Torque => 0.0,
        Kind::Pd => applied.by_kp * actuator.kp_of(command),
        Kind::Current | Kind::DcMotor | Kind::PositionServo => applied.by_gain * actuator.gain,
    }
}

/// A torque at every sample, by the actuator's kind, what it has to put out so that `torque` (N m) is left beside what a payload takes, what of
/// that its gain does not make, and what it applied; none where it does not follow its command. What the recorded commands make of a gain holds
/// their noise, and would explain the torque, which is made of them, by itself.
fn by_need(state: &JointState, torque: &[f64], part: impl Fn(&Actuator, &Applied, [f64; 2]) -> f64) -> Vec<f64> {
    let Some(commanded) = &state.commanded else { return vec![0.0; state.len()] };
    let needed = commanded.needed(torque);
    commanded.map(|actuator, command, i| {
        let applied = actuator.apply(command, motion(state, i));
        if !applied.follows_command() {
            return 0.0;
        }
        let beside_gain = applied.at(state.velocity[i]) - by_gain(actuator, command, &applied);
        part(actuator, &applied, [needed[i], beside_gain])
    })
}

/// Torque that the gain of an actuator has to make at every sample, N m, as [`by_need`].
fn asked_of_gain(state: &JointState, torque: &[f64]) -> Vec<f64> {
    by_need(state, torque, |_, _, [needed, beside_gain]| needed - beside_gain)
}
