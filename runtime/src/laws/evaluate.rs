//! The static law of a model: inputs in, friction out.

use frikan_shared::expression::Program;
use frikan_shared::integer_table::IntegerTable;
use frikan_shared::model::{Input, Law, MAX_INPUTS, Model};
use frikan_shared::table::Table;

pub use crate::bounds::limited;
use crate::bounds::unless;
use crate::laws::expression::run;
use crate::laws::integer_table::evaluate_steps;
use crate::laws::network::evaluate_network;
use crate::laws::table::{evaluate_geometric, evaluate_table};

/// Whether the features that this firmware was built with suffice for a model.
#[must_use]
pub fn is_built_in<const CELLS: usize>(model: &Model<CELLS>) -> bool {
    let is_law = match model.law {
        Law::Expression(_) => cfg!(feature = "expression"),
        Law::Network(_) => cfg!(feature = "network"),
        _ => true,
    };
    is_law && (cfg!(feature = "effects") || model.effects.is_empty())
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
        Law::Network(network) if cfg!(feature = "network") => evaluate_network(network, inputs, &model.cells),
        Law::Expression(program) if cfg!(feature = "expression") => evaluate_expression(model, inputs, program),
        Law::IntegerTable(table) => evaluate_integer_table(model, table, *first),
        // No compensator takes a model of these.
        Law::Network(_) | Law::Expression(_) => 0.0,
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
