//! What is known of an actuator that stands for a recorded torque, for a reader and for JSON.

use serde_json::{Map, Value};

use crate::servo::Identified;

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
