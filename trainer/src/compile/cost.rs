//! What an evaluation costs on a drive, worked out beforehand: instructions of a Cortex-M4F, the same for every input.
//!
//! The figures per operation were counted under emulation and add up exactly; `tests/tests/instructions.rs` counts them again.

use frikan_shared::expression::{Operation, Program};
use frikan_shared::model::{Law, Model};
use frikan_shared::network::Network;

use super::profile::Profile;

/// Of a program of no operations, the call included.
const PROGRAM: u32 = 74;
/// Of a table with cells that grow from zero, of equal cells, and of integers from and to floating point.
const GEOMETRIC_TABLE: u32 = 42;
const UNIFORM_TABLE: u32 = 34;
const INTEGER_TABLE: u32 = 77;
/// Of a network of one input and one hidden layer of sums, and of each of its nodes.
const ONE_HIDDEN_LAYER: u32 = 58;
const NODE: u32 = 19;
/// Of any other network, to a hundredth, and of each hidden layer, input, node, product of two sums, and edge in it.
const NETWORK: u32 = 163;
const LAYER: u32 = 101;
const SOURCE: u32 = 28;
const INNER_NODE: u32 = 13;
const PRODUCT: u32 = 49;
const EDGE: u32 = 22;

/// What a step of the float compensator takes on a drive without floating-point unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FloatStep {
    /// Row of docs/drive-cost.md: the kind of law that was counted.
    pub row: &'static str,
    /// Fewest and most instructions, by the input.
    pub instructions: [u32; 2],
}

/// The rows of docs/drive-cost.md.
const TABLE_ROW: &str = "symmetric table";
const UNIFORM_ROW: &str = "uniform table";
const FORMULA_ROW: &str = "Stribeck expression";
const NETWORK_ROW: &str = "network [1,5,1]";
/// Fewest and most instructions of each row.
type Rows = [(&'static str, [u32; 2]); 4];
/// Rows of docs/drive-cost.md for drives without floating-point unit: a step, instructions.
const FLOAT_STEPS: [(&str, Rows); 3] = [
    (
        "cortex-m0plus",
        [
            (TABLE_ROW, [1172, 1682]),
            (UNIFORM_ROW, [1488, 2037]),
            (FORMULA_ROW, [3694, 7029]),
            (NETWORK_ROW, [2559, 3132]),
        ],
    ),
    ("riscv32imac", RISCV_FLOAT_STEPS),
    ("riscv32imc", RISCV_FLOAT_STEPS),
];
const RISCV_FLOAT_STEPS: Rows =
    [(TABLE_ROW, [649, 985]), (UNIFORM_ROW, [944, 1293]), (FORMULA_ROW, [2372, 4021]), (NETWORK_ROW, [835, 1172])];

/// Fewest and most instructions by which the rows of docs/drive-cost.md with one correction term, of four elements at most, are above that of [`TABLE_ROW`].
const FLOAT_TERMS: [(&str, [u32; 2]); 3] =
    [("cortex-m0plus", [1070, 20552]), ("riscv32imac", RISCV_FLOAT_TERMS), ("riscv32imc", RISCV_FLOAT_TERMS)];
const RISCV_FLOAT_TERMS: [u32; 2] = [788, 11365];

/// Instructions of a step of the integer compensator, the same for every count; `tests/tests/emulation_integer.rs` counts them again.
const INTEGER_STEPS: [(&str, u32); 3] = [("cortex-m0plus", 139), ("riscv32imac", 124), ("riscv32imc", 124)];

/// What the documented law of the same kind takes in floats, limits included, on a drive without floating-point unit; none for other drives.
#[must_use]
pub fn float_step(target: &str, law: &Law) -> Option<FloatStep> {
    let row = match law {
        Law::Geometric(_) | Law::IntegerTable(_) => TABLE_ROW,
        Law::Uniform(_) => UNIFORM_ROW,
        Law::Expression(_) => FORMULA_ROW,
        Law::Network(_) => NETWORK_ROW,
    };
    let (_, rows) = FLOAT_STEPS.into_iter().find(|(name, _)| *name == target)?;
    let (row, instructions) = rows.into_iter().find(|(kind, _)| *kind == row)?;
    Some(FloatStep { row, instructions })
}

/// By how many instructions, at least and at most, a correction term makes a step in floats longer on a drive without floating-point unit; none for other
/// drives.
#[must_use]
pub fn float_term(target: &str) -> Option<[u32; 2]> {
    FLOAT_TERMS.into_iter().find_map(|(name, instructions)| (name == target).then_some(instructions))
}

/// What a step of a model in floats takes on a drive without floating-point unit, in a sentence; none for other drives.
#[must_use]
pub fn in_floats<const CELLS: usize>(target: Profile, model: &Model<CELLS>) -> Option<String> {
    let name = target.name;
    let FloatStep { row, instructions: [least, most] } = float_step(name, &model.law)?;
    let terms = match (model.effects.len(), float_term(name)?) {
        (0, _) => String::new(),
        (1, [least, most]) => format!(", the correction beside it {least} to {most} more"),
        (many, [least, most]) => format!(", each of the {many} corrections beside it {least} to {most} more"),
    };
    let in_integers = integer_step(name)?;
    Some(format!(
        "{name} has no floating-point unit: in floats a step of a {row} takes {least} to {most} instructions there{terms} (docs/drive-cost.md; `trainer verify \
         --target {name}` counts those of the image). A law of the velocity alone takes {in_integers} as a table of integers (`trainer fit --target {name}`)"
    ))
}

/// Instructions of a step of the integer compensator on a drive without floating-point unit; none for other drives.
#[must_use]
pub fn integer_step(target: &str) -> Option<u32> {
    INTEGER_STEPS.into_iter().find_map(|(name, instructions)| (name == target).then_some(instructions))
}

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
    let sources = network.sources().len() as u32;
    let mut width = network.sources().len();
    let (mut nodes, mut products, mut edges) = (0, 0, 0);
    for layer in network.layers() {
        edges += width * layer.targets();
        width = layer.nodes();
        nodes += width;
        products += usize::from(layer.products);
    }
    edges += width;
    let of_layers = LAYER * network.layers().len() as u32 + INNER_NODE * nodes as u32 + PRODUCT * products as u32;
    NETWORK + SOURCE * sources + of_layers + EDGE * edges as u32
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
