//! A table of integers for a reader, and as JSON.

use serde_json::{Value, json};

use crate::compile::integers::q_format;
use crate::fit::{IntegerSummary, Outcome};
use crate::law::significant;

/// Significant digits of printed figures.
const DIGITS: usize = 3;

/// The unit of the velocity.
fn velocity_unit(outcome: &Outcome) -> &'static str {
    outcome.inputs.first().map_or("", |velocity| velocity.unit)
}

/// What `trainer fit` prints of it.
pub(super) fn text(integers: &IntegerSummary, outcome: &Outcome) -> String {
    let IntegerSummary { target, cells, counts, error, instructions, in_floats } = integers;
    let (unit, of_velocity) = (outcome.unit, velocity_unit(outcome));
    let count = |count: f32, unit: &str| {
        let format = q_format(count).map_or(String::new(), |format| format!("{format}, "));
        format!("{format}counts of {} {unit}", significant(f64::from(count), DIGITS))
    };
    let instructions =
        instructions.map_or(String::new(), |number| format!(" takes {number} instructions a step on {target}"));
    let in_floats = in_floats.map_or(String::new(), |step| {
        let [least, most] = step.instructions;
        format!("; in floats a {} takes {least} to {most} there (docs/drive-cost.md)", step.row)
    });
    format!(
        "\nintegers    a table of {cells} cells{instructions}{in_floats}\n            velocity in {}, torque in {}\n            \
         at every one of {} counts within {} {unit} of the law ({} % of the largest friction), furthest at {} {of_velocity}; root mean square {} {unit}\n",
        count(counts.velocity, of_velocity),
        count(counts.torque, unit),
        error.counts,
        significant(error.largest, DIGITS),
        significant(100.0 * error.share(), DIGITS),
        significant(error.at, DIGITS),
        significant(error.rms, DIGITS),
    )
}

/// The same for `--json`.
pub(super) fn to_json(integers: &IntegerSummary, outcome: &Outcome) -> Value {
    let IntegerSummary { target, cells, counts, error, instructions, in_floats } = integers;
    let count = |count: f32, unit: &str| json!({"value": f64::from(count), "unit": unit, "format": q_format(count)});
    json!({
        "target": target,
        "cells": cells,
        "velocity_count": count(counts.velocity, velocity_unit(outcome)),
        "torque_count": count(counts.torque, outcome.unit),
        "error": {
            "counts": error.counts, "largest": error.largest, "at": error.at, "rms": error.rms, "share": error.share(),
        },
        "instructions": instructions,
        "in_floats": in_floats.map(|step| json!({"instructions": step.instructions, "row": step.row})),
    })
}
