//! The static law of a model: inputs in, friction out.

use frikan_shared::model::{Input, Law, MAX_INPUTS, Model};

use crate::expression::run;
use crate::integer_table::evaluate_steps;
use crate::network::evaluate_network;
use crate::table::evaluate_table;

/// `value` held to `[-limit, limit]`; zero for NaN.
#[must_use]
#[inline(always)]
pub fn limited(value: f32, limit: f32) -> f32 {
    let value = if value.is_nan() { 0.0 } else { value };
    let value = if value < limit { value } else { limit };
    if value > -limit { value } else { -limit }
}

/// The channels of `inputs`, each held to its trained range; NaN stays NaN.
#[must_use]
#[inline(always)]
pub fn held(channels: &[Input], inputs: &[f32; MAX_INPUTS]) -> [f32; MAX_INPUTS] {
    let mut held = *inputs;
    for (value, channel) in held.iter_mut().zip(channels) {
        let below = if *value > channel.high { channel.high } else { *value };
        *value = if below < channel.low { channel.low } else { below };
    }
    held
}

/// Friction that the static law of `model` gives for `inputs`, in the order of the model's channels; channels that the
/// model does not have are ignored. In the unit of the model's output, finite, at most `output_limit` in magnitude.
///
/// NaN in a channel gives 0. Effects and rigid body are not part of the static law.
#[must_use]
#[inline]
pub fn evaluate<const CELLS: usize>(model: &Model<CELLS>, inputs: &[f32; MAX_INPUTS]) -> f32 {
    let [first, ..] = *inputs;
    match &model.law {
        Law::Table(table) => {
            let value = if first.is_nan() { 0.0 } else { evaluate_table(table, &model.cells, first) };
            limited(value, model.output_limit)
        }
        Law::Network(network) => {
            let value = evaluate_network(network, &model.cells, inputs, model.inputs.len());
            limited(if any_nan(&model.inputs, inputs) { 0.0 } else { value }, model.output_limit)
        }
        Law::Expression(program) => {
            let value = run(program, &held(&model.inputs, inputs));
            limited(if any_nan(&model.inputs, inputs) { 0.0 } else { value }, model.output_limit)
        }
        Law::IntegerTable(table) => {
            let value = if first.is_nan() { 0.0 } else { evaluate_steps(table, &model.cells, first) };
            limited(value, model.output_limit)
        }
    }
}

/// Whether a channel of the model is NaN.
fn any_nan(channels: &[Input], inputs: &[f32; MAX_INPUTS]) -> bool {
    inputs.iter().zip(channels).fold(false, |any, (input, _)| any | input.is_nan())
}
