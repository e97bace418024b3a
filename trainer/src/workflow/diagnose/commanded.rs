//! Joints that report no torque: what their actuators made of the commands stands for it.

use crate::actuator::Kind;
use crate::error::Result;
use crate::joint::Joint;
use crate::recording::Recording;
use crate::servo::{Identified, identify, known_torque};
use serde_json::{Map, Value};

/// What is known of the actuator of a joint that reports no torque: what its file gives, and of the rest what the simulation tells, whose
/// constants are those of the simulator, or else the recordings themselves. `None` of a joint that reports torque.
///
/// # Errors
/// As [`identify`].
pub(super) fn actuator(
    recordings: &[Recording],
    simulation: Option<&Recording>,
    joint: &Joint,
) -> Result<Option<Identified>> {
    match (joint.actuator.kind, simulation) {
        (Kind::Torque, _) => Ok(None),
        (_, None) => identify(recordings, joint).map(Some),
        (_, Some(simulation)) => identify(std::slice::from_ref(simulation), &joint.of_simulation()).map(Some),
    }
}

/// A recording under the torque that its actuator made, less what its payload takes; itself where it has a torque of its own.
///
/// # Errors
/// As [`known_torque`].
pub(super) fn under_torque(recording: Recording, joint: &Joint, actuator: Option<&Identified>) -> Result<Recording> {
    match actuator {
        Some(identified) => known_torque(&recording, joint, identified, 0.0, true),
        None => Ok(recording),
    }
}

/// The constants in force, for JSON.
pub(super) fn constants(actuator: &Identified) -> Value {
    let constants = actuator.partial.in_force().into_iter();
    Value::Object(constants.map(|(constant, value)| (constant.key().to_owned(), value.into())).collect::<Map<_, _>>())
}

/// Where the torque comes from, in a sentence.
pub(super) fn sentence(actuator: &Identified) -> String {
    let constants = actuator.partial.in_force().into_iter();
    let told: Vec<String> = constants.map(|(constant, value)| format!("{} {value:.4}", constant.key())).collect();
    let told = told.join(", ");
    format!(
        "The torque is what the actuator makes of its commands ({told}): a wrong constant of it shows as a wrong torque."
    )
}
