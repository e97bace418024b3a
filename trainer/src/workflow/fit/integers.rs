//! A table of integers for a reader, and as JSON.

use serde_json::{Value, json};

use crate::compile::integers::q_format;
use crate::fit::{IntegerSummary, Outcome};

/// The unit of the velocity.
fn velocity_unit(outcome: &Outcome) -> &'static str {
    outcome.inputs.first().map_or("", |velocity| velocity.unit)
}

/// What `trainer fit` prints of it.
pub(super) fn text(integers: &IntegerSummary, outcome: &Outcome) -> String {
    let [table, counts, error] = integers.told([velocity_unit(outcome), outcome.unit]);
    format!("\nintegers    {table}\n            {counts}\n            {error}\n")
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
