//! H6 to H9: what the actuator of a joint without torque sensor does otherwise than its constants say. The torque that is compared is what it
//! would have made of its commands by these (the law of `crate::actuator`); an effect is what it makes less by others.

mod dead_band;
mod delay;
mod gain;
mod limit;

use super::JointState;
use crate::actuator::{Commanded, Motion};

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
