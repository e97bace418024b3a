//! The static law of a model: inputs in, friction out.

use frikan_shared::expression::Program;
use frikan_shared::integer_table::IntegerTable;
use frikan_shared::model::{Input, Law, MAX_INPUTS, Model};
use frikan_shared::table::{SIGN_BIT, Table};

use crate::expression::run;
use crate::integer_table::evaluate_steps;
use crate::network::evaluate_network;
use crate::table::{evaluate_geometric, evaluate_table};

/// `value` held to `[-limit, limit]`; zero for NaN. `limit` must not be NaN, and its sign does not count.
///
/// In integers, which order the magnitudes of floats as their bits: no comparison of floats, whose flags take time to fetch.
#[must_use]
#[inline(always)]
pub fn limited(value: f32, limit: f32) -> f32 {
    let magnitude = value.abs().to_bits();
    let held = magnitude.min(limit.abs().to_bits()) | (value.to_bits() & SIGN_BIT);
    unless(magnitude > f32::INFINITY.to_bits(), f32::from_bits(held))
}

/// `value` held to `[-limit, limit]`, for values and limits that are no NaN and limits that are not negative; some number for others.
#[must_use]
#[inline(always)]
pub(crate) fn within(value: f32, limit: f32) -> f32 {
    f32::from_bits(value.abs().to_bits().min(limit.to_bits()) | (value.to_bits() & SIGN_BIT))
}

/// A channel held to its trained range; NaN stays NaN.
#[must_use]
#[inline(always)]
pub fn held(input: &Input, channel: f32) -> f32 {
    let below = if channel > input.high { input.high } else { channel };
    if below < input.low { input.low } else { below }
}

/// Friction that the static law of `model` gives for `inputs`, in the order of the model's channels; channels that the
/// model does not have are ignored. In the unit of the model's output, finite, at most `output_limit` in magnitude.
///
/// NaN in a channel that the law reads gives 0: a table reads the first, networks and expressions read all. Effects and rigid body
/// are not part of the static law.
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

/// The laws that take longer than a call, each a function of its own: none saves the registers of another.
#[inline(never)]
fn evaluate_other<const CELLS: usize>(model: &Model<CELLS>, inputs: &[f32; MAX_INPUTS]) -> f32 {
    let [first, ..] = inputs;
    match &model.law {
        Law::Geometric(layout) => evaluate_geometric(layout, &model.cells, *first),
        // Validation has proved what tables give to be within the limit.
        Law::Uniform(layout) => unless(first.is_nan(), evaluate_table(&Table::Uniform(*layout), &model.cells, *first)),
        Law::Network(network) => evaluate_network(network, inputs, &model.cells),
        Law::Expression(program) => evaluate_expression(model, inputs, program),
        Law::IntegerTable(table) => evaluate_integer_table(model, table, *first),
    }
}

#[inline(never)]
fn evaluate_expression<const CELLS: usize>(model: &Model<CELLS>, inputs: &[f32; MAX_INPUTS], program: &Program) -> f32 {
    // Channels that the model does not have are 0, whatever they hold.
    let mut channels = [0.0; MAX_INPUTS];
    for ((channel, value), input) in channels.iter_mut().zip(inputs).zip(&model.inputs) {
        *channel = held(input, *value);
    }
    let inputs = channels;
    let any_nan = inputs.iter().fold(false, |any, input| any | input.is_nan());
    limited(unless(any_nan, run(program, &inputs)), model.output_limit)
}

#[inline(never)]
fn evaluate_integer_table<const CELLS: usize>(model: &Model<CELLS>, table: &IntegerTable, input: f32) -> f32 {
    let value = evaluate_steps(table, &model.cells, input);
    limited(unless(input.is_nan(), value), model.output_limit)
}

/// 0 instead of `value` where `off`.
#[inline(always)]
fn unless(off: bool, value: f32) -> f32 {
    f32::from_bits(if off { 0 } else { value.to_bits() })
}
