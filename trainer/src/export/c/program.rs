//! A postfix program as C statements, one for each operation.

use std::fmt::Write;

use frikan_shared::expression::{Operation, Program};
use frikan_shared::model::Input;

use super::literal;

/// The statements of a function whose parameters are `names`, with its return.
pub(super) fn statements(
    out: &mut String,
    program: &Program,
    inputs: &[Input],
    names: &[String],
    limit: f32,
) -> std::fmt::Result {
    for (index, (input, name)) in inputs.iter().zip(names).enumerate() {
        writeln!(out, "    const float x{index} = held({name}, {}, {});", literal(input.low), literal(input.high))?;
        // A program need not read every input.
        writeln!(out, "    (void)x{index};")?;
    }
    let mut stack: Vec<String> = Vec::new();
    for (number, operation) in program.operations.iter().enumerate() {
        let value = value(*operation, &mut stack);
        writeln!(out, "    const float t{number} = {value};")?;
        stack.push(format!("t{number}"));
    }
    let any_nan: Vec<String> = names.iter().map(|name| format!("{name} != {name}")).collect();
    let result = stack.pop().unwrap_or_default();
    writeln!(out, "    return {} ? 0.0f : limited({result}, {});", any_nan.join(" || "), literal(limit))
}

/// The expression of one operation, whose operands are taken from the stack. A validated program has them.
fn value(operation: Operation, stack: &mut Vec<String>) -> String {
    let mut pop = || stack.pop().unwrap_or_default();
    let binary = |pop: &mut dyn FnMut() -> String, operator: &str| {
        let (a, b) = (pop(), pop());
        format!("{b} {operator} {a}")
    };
    match operation {
        Operation::Input(index) => format!("x{index}"),
        Operation::ScaledInput(index, factor) => format!("x{index} * {}", literal(factor)),
        Operation::Constant(constant) => literal(constant),
        Operation::Scale(factor) => format!("{} * {}", pop(), literal(factor)),
        Operation::Offset(summand) => format!("{} + {}", pop(), literal(summand)),
        Operation::Add => binary(&mut pop, "+"),
        Operation::Subtract => binary(&mut pop, "-"),
        Operation::Multiply => binary(&mut pop, "*"),
        Operation::Divide => binary(&mut pop, "/"),
        Operation::Minimum | Operation::Maximum => {
            let (a, b) = (pop(), pop());
            let comparison = if operation == Operation::Minimum { "<" } else { ">" };
            format!("{b} {comparison} {a} ? {b} : {a}")
        }
        Operation::Power => {
            let (a, b) = (pop(), pop());
            format!("f_power({b}, {a})")
        }
        Operation::PowerOf(exponent) => format!("f_power({}, {})", pop(), literal(exponent)),
        Operation::Negate => format!("-{}", pop()),
        Operation::Absolute => format!("magnitude_of({})", pop()),
        Operation::Square => {
            let a = pop();
            format!("{a} * {a}")
        }
        Operation::Reciprocal => format!("1.0f / {}", pop()),
        Operation::Exp => format!("f_exp({})", pop()),
        Operation::Log => format!("f_log({})", pop()),
        Operation::Tanh => format!("f_tanh({})", pop()),
        Operation::Sin => format!("f_sin({})", pop()),
        Operation::Cos => format!("f_cos({})", pop()),
        Operation::Atan => format!("f_atan({})", pop()),
        Operation::SquareRoot => format!("f_square_root({})", pop()),
        Operation::Sign => format!("f_sign({})", pop()),
        Operation::ScaledMagnitude(index, factor) => format!("magnitude_of(x{index}) * {}", literal(factor)),
        Operation::AddScaledInput(index, factor) => format!("{} + x{index} * {}", pop(), literal(factor)),
    }
}
