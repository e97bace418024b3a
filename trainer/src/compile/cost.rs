//! What an evaluation costs on a drive, worked out beforehand: instructions of a Cortex-M4F, the same for every input.
//!
//! The figures per operation were counted under emulation and add up exactly; `tests/tests/instructions.rs` counts them again.

use frikan_shared::expression::{Operation, Program};
use frikan_shared::model::{Law, Model};
use frikan_shared::network::{Network, Outer};

/// Of a program of no operations, the call included.
const PROGRAM: u32 = 98;
/// Of a table with cells that grow from zero, of equal cells, and of integers.
const GEOMETRIC_TABLE: u32 = 45;
const UNIFORM_TABLE: u32 = 73;
const INTEGER_TABLE: u32 = 50;
/// Of a layer, of a node whose place in its table is found, of an edge, and of a hyperbolic tangent at the end.
const LAYER: u32 = 203;
const SOURCE: u32 = 23;
const EDGE: u32 = 25;
const TANH_AT_END: u32 = 65;

/// Instructions of one evaluation of the law of a model, without effects.
#[must_use]
pub fn instructions<const CELLS: usize>(model: &Model<CELLS>) -> u32 {
    match &model.law {
        Law::Geometric(_) => GEOMETRIC_TABLE,
        Law::Uniform(_) => UNIFORM_TABLE,
        Law::IntegerTable(_) => INTEGER_TABLE,
        Law::Network(network) => of_network(network, model.inputs.len()),
        Law::Expression(program) => of_program(program),
    }
}

fn of_network(network: &Network, inputs: usize) -> u32 {
    let mut width = inputs;
    let mut edges = 0;
    for layer in &network.layers {
        edges += width * layer.targets();
        width = layer.outputs();
    }
    let end = if matches!(network.outer, Outer::Linear) { 0 } else { TANH_AT_END };
    LAYER * network.layers.len() as u32 + SOURCE * network.sources.len() as u32 + EDGE * edges as u32 + end
}

/// Instructions of one evaluation of a program.
#[must_use]
pub fn of_program(program: &Program) -> u32 {
    PROGRAM + program.operations.iter().map(|operation| of_operation(*operation)).sum::<u32>()
}

fn of_operation(operation: Operation) -> u32 {
    match operation {
        Operation::Constant(_) => 14,
        Operation::Negate | Operation::Absolute | Operation::Square => 19,
        Operation::Input(_)
        | Operation::Scale(_)
        | Operation::Reciprocal
        | Operation::Add
        | Operation::Subtract
        | Operation::Multiply
        | Operation::Divide => 20,
        Operation::Offset(_) => 21,
        Operation::ScaledInput(..) => 22,
        Operation::Maximum => 23,
        Operation::Minimum => 24,
        Operation::Sign => 26,
        Operation::Tanh => 60,
        Operation::Sin | Operation::Cos => 65,
        Operation::Exp => 66,
        Operation::Log => 69,
        Operation::Atan => 70,
        Operation::SquareRoot => 88,
        Operation::PowerOf(_) | Operation::Power => 128,
    }
}
