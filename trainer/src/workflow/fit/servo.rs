//! What a fit tells of a joint that reports no torque.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::actuator::Constant;
use crate::servo::{Identified, ServoFit, Simulated};

/// Position errors of the simulated joint as JSON.
pub(super) fn to_json(fit: &ServoFit) -> Value {
    let of = |simulated: &Simulated| {
        let label = &simulated.label;
        simulated.score.map(|score| {
            json!({"recording": label, "n": score.n, "velocity": {"rmse": score.velocity_rmse},
                "position": {"mae": score.mae, "rmse": score.rmse, "max": score.max}})
        })
    };
    let list = |of_set: &[Simulated]| of_set.iter().filter_map(of).collect::<Vec<_>>();
    json!({"unit": "rad", "train": list(&fit.train), "test": list(&fit.tests)})
}

/// The constants in force as `[actuator]` of a joint.toml.
pub(super) fn table(identified: &Identified) -> String {
    let mut text =
        String::from("# What was identified of the actuator, beside what joint.toml says of it.\n[actuator]\n");
    // Writing to a string cannot fail.
    let _ = writeln!(text, "kind = \"{}\"", identified.partial.actuator.kind.name());
    for (constant, value) in identified.partial.in_force() {
        let _ = writeln!(text, "{} = {value}", Constant::key(constant));
    }
    text
}

/// How far the simulated joint comes off, for a reader.
pub(super) fn text(fit: &ServoFit) -> String {
    let mut text = String::from("\nsimulated under the recorded commands: mean absolute error of the position\n");
    let train = fit.train.iter().map(|simulated| ("train", simulated));
    for (role, Simulated { label, score }) in train.chain(fit.tests.iter().map(|simulated| ("test", simulated))) {
        let error = score.map_or("cannot be simulated".to_owned(), |score| format!("{:.4} rad", score.mae));
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  {label:<32} {role:<5} {error}");
    }
    text
}
