//! What an evaluation costs on a drive, worked out beforehand: instructions of a Cortex-M4F, the same for every input.
//!
//! The figures per operation were counted under emulation and add up exactly; `tests/tests/instructions.rs` counts them again.

use frikan_shared::expression::{Operation, Program};
use frikan_shared::model::{Law, Model};
use frikan_shared::network::Network;

/// Of a program of no operations, the call included.
const PROGRAM: u32 = 74;
/// Of a table with cells that grow from zero, of equal cells, and of integers from and to floating point.
const GEOMETRIC_TABLE: u32 = 41;
const UNIFORM_TABLE: u32 = 34;
const INTEGER_TABLE: u32 = 77;
/// Of a network of one input and one hidden layer of sums, and of each of its nodes.
const ONE_HIDDEN_LAYER: u32 = 58;
const NODE: u32 = 19;
/// Of any other network, and of a hidden layer, of an input or node whose place is found, and of an edge in it.
const NETWORK: u32 = 197;
const LAYER: u32 = 73;
const PLACE: u32 = 23;
const EDGE: u32 = 25;

/// Instructions of one evaluation of the law of a model, without effects.
#[must_use]
pub fn instructions<const CELLS: usize>(model: &Model<CELLS>) -> u32 {
    match &model.law {
        Law::Geometric(_) => GEOMETRIC_TABLE,
        Law::Uniform(_) => UNIFORM_TABLE,
        Law::IntegerTable(_) => INTEGER_TABLE,
        Law::Network(network) => of_network(network),
        Law::Expression(program) => of_program(program),
    }
}

fn of_network(network: &Network) -> u32 {
    if let Some(layer) = &network.one_hidden_layer {
        return ONE_HIDDEN_LAYER + NODE * layer.nodes;
    }
    let mut width = network.sources().len();
    let (mut places, mut edges) = (width, 0);
    for layer in network.layers() {
        edges += width * layer.targets();
        width = layer.nodes();
        places += width;
    }
    edges += width;
    NETWORK + LAYER * network.layers().len() as u32 + PLACE * places as u32 + EDGE * edges as u32
}

/// Instructions of one evaluation of a program.
#[must_use]
pub fn of_program(program: &Program) -> u32 {
    PROGRAM + program.operations.iter().map(|operation| of_operation(*operation)).sum::<u32>()
}

fn of_operation(operation: Operation) -> u32 {
    match operation {
        Operation::Negate | Operation::Absolute | Operation::Square => 7,
        Operation::Scale(_) | Operation::Offset(_) | Operation::Reciprocal => 8,
        Operation::Add | Operation::Subtract | Operation::Multiply | Operation::Divide => 11,
        Operation::AddScaledInput(..) => 13,
        Operation::Constant(_) | Operation::Minimum | Operation::Maximum => 14,
        Operation::Sign => 16,
        Operation::Input(_) => 17,
        Operation::ScaledInput(..) => 20,
        Operation::ScaledMagnitude(..) => 21,
        Operation::Tanh => 39,
        Operation::Exp => 45,
        Operation::Sin => 47,
        Operation::Cos => 48,
        Operation::Atan => 53,
        Operation::Log => 61,
        Operation::SquareRoot => 75,
        Operation::PowerOf(_) => 120,
        Operation::Power => 125,
    }
}
