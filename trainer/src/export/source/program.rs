//! A postfix program as statements, one for each operation.

use frikan_shared::expression::{Operation, Program};

use super::language::Language;

/// Adds the statements of a program over `x0, x1, ...` and returns the name of its value.
pub(super) fn statements(out: &mut Vec<String>, language: Language, program: &Program) -> String {
    let mut stack: Vec<String> = Vec::new();
    for (number, operation) in program.operations.iter().enumerate() {
        let value = value(language, *operation, &mut stack);
        out.push(language.constant(&format!("t{number}"), &value));
        stack.push(format!("t{number}"));
    }
    stack.pop().unwrap_or_default()
}

/// Whether an operation reads the input of this number.
pub(super) fn reads(operation: &Operation, input: usize) -> bool {
    use Operation::{AddScaledInput, Input, ScaledInput, ScaledMagnitude};
    match operation {
        Input(index) | ScaledInput(index, _) | ScaledMagnitude(index, _) | AddScaledInput(index, _) => {
            usize::from(*index) == input
        }
        _ => false,
    }
}

/// The expression of one operation, whose operands are taken from the stack. A validated program has them.
fn value(language: Language, operation: Operation, stack: &mut Vec<String>) -> String {
    let number = |x: f32| language.number(x);
    match operation {
        Operation::Input(index) => format!("x{index}"),
        Operation::ScaledInput(index, factor) => format!("x{index} * {}", number(factor)),
        Operation::Constant(constant) => number(constant),
        Operation::ScaledMagnitude(index, factor) => format!("magnitude_of(x{index}) * {}", number(factor)),
        Operation::Scale(factor) => format!("{} * {}", pop(stack), number(factor)),
        Operation::Offset(summand) => format!("{} + {}", pop(stack), number(summand)),
        Operation::AddScaledInput(index, factor) => format!("{} + x{index} * {}", pop(stack), number(factor)),
        Operation::PowerOf(exponent) => format!("f_power({}, {})", pop(stack), number(exponent)),
        Operation::Negate => format!("-{}", pop(stack)),
        Operation::Absolute => format!("magnitude_of({})", pop(stack)),
        Operation::Square => format!("squared({})", pop(stack)),
        Operation::Reciprocal => format!("divided({}, {})", number(1.0), pop(stack)),
        Operation::Exp => format!("f_exp({})", pop(stack)),
        Operation::Log => format!("f_log({})", pop(stack)),
        Operation::Tanh => format!("f_tanh({})", pop(stack)),
        Operation::Sin => format!("f_sin({})", pop(stack)),
        Operation::Cos => format!("f_cos({})", pop(stack)),
        Operation::Atan => format!("f_atan({})", pop(stack)),
        Operation::SquareRoot => format!("f_square_root({})", pop(stack)),
        Operation::Sign => format!("f_sign({})", pop(stack)),
        Operation::Add => infix(stack, "+"),
        Operation::Subtract => infix(stack, "-"),
        Operation::Multiply => infix(stack, "*"),
        Operation::Divide => called(stack, "divided"),
        Operation::Minimum => called(stack, "least"),
        Operation::Maximum => called(stack, "most"),
        Operation::Power => called(stack, "f_power"),
    }
}

fn pop(stack: &mut Vec<String>) -> String {
    stack.pop().unwrap_or_default()
}

/// An operator between two operands.
fn infix(stack: &mut Vec<String>, operator: &str) -> String {
    let (right, left) = (pop(stack), pop(stack));
    format!("{left} {operator} {right}")
}

/// A function of two operands.
fn called(stack: &mut Vec<String>, function: &str) -> String {
    let (second, first) = (pop(stack), pop(stack));
    format!("{function}({first}, {second})")
}
