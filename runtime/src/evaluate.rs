//! The static law of a model: inputs in, friction out.

use frikan_shared::model::{Input, Law, MAX_INPUTS, Model};
use frikan_shared::table::Table;

use crate::expression::run;
use crate::integer_table::evaluate_steps;
use crate::network::evaluate_network;
use crate::table::{evaluate_geometric, evaluate_table};

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
    // The commonest law comes first and keeps to registers; validation has proved its values finite and within the limit.
    if let Law::Geometric(layout) = &model.law {
        let [input, ..] = *inputs;
        return evaluate_geometric(layout, &model.cells, input);
    }
    evaluate_other(model, inputs)
}

/// The laws that take longer than a call.
#[inline(never)]
fn evaluate_other<const CELLS: usize>(model: &Model<CELLS>, inputs: &[f32; MAX_INPUTS]) -> f32 {
    let value = match &model.law {
        Law::Geometric(layout) => evaluate_geometric(layout, &model.cells, inputs[0]),
        Law::Uniform(layout) => evaluate_table(&Table::Uniform(*layout), &model.cells, inputs[0]),
        Law::Network(network) => evaluate_network(network, &model.cells, inputs, model.inputs.len()),
        Law::Expression(program) => run(program, &held(&model.inputs, inputs)),
        Law::IntegerTable(table) => evaluate_steps(table, &model.cells, inputs[0]),
    };
    limited(if any_nan(&model.inputs, inputs) { 0.0 } else { value }, model.output_limit)
}

/// Whether a channel of the model is NaN.
fn any_nan(channels: &[Input], inputs: &[f32; MAX_INPUTS]) -> bool {
    inputs.iter().zip(channels).fold(false, |any, (input, _)| any | input.is_nan())
}
