//! The program of an image as an expression again: what is rendered for other languages is what the drive evaluates.

use frikan_shared::expression::{Operation, Program};

use super::expression::{Expr, Unary};

/// The expression that a program computes, inputs by their number; its constants are the very numbers of the image. `None`
/// for an ill-formed program and for operations that no law of ours contains (minimum, maximum, sign).
#[must_use]
pub fn expression_of(program: &Program) -> Option<Expr> {
    let mut stack: Vec<Expr> = Vec::new();
    for operation in &program.operations {
        let expression = match *operation {
            Operation::Input(index) => Expr::Input(usize::from(index)),
            Operation::ScaledInput(index, factor) => number(factor) * Expr::Input(usize::from(index)),
            Operation::ScaledMagnitude(index, factor) => {
                number(factor) * Expr::Input(usize::from(index)).then(Unary::Abs)
            }
            Operation::AddScaledInput(index, factor) => stack.pop()? + number(factor) * Expr::Input(usize::from(index)),
            Operation::Constant(value) => number(value),
            Operation::Scale(factor) => number(factor) * stack.pop()?,
            Operation::Offset(summand) => number(summand) + stack.pop()?,
            Operation::PowerOf(exponent) => stack.pop()?.pow(number(exponent)),
            Operation::Reciprocal => Expr::Const(1.0) / stack.pop()?,
            Operation::Add | Operation::Subtract | Operation::Multiply | Operation::Divide | Operation::Power => {
                let (right, left) = (stack.pop()?, stack.pop()?);
                match operation {
                    Operation::Add => left + right,
                    Operation::Subtract => left - right,
                    Operation::Multiply => left * right,
                    Operation::Divide => left / right,
                    _ => left.pow(right),
                }
            }
            Operation::Minimum | Operation::Maximum | Operation::Sign => return None,
            Operation::Negate
            | Operation::Absolute
            | Operation::Square
            | Operation::Exp
            | Operation::Log
            | Operation::Tanh
            | Operation::Sin
            | Operation::Cos
            | Operation::Atan
            | Operation::SquareRoot => stack.pop()?.then(unary(*operation)?),
        };
        stack.push(expression);
    }
    stack.pop().filter(|_| stack.is_empty())
}

/// The shortest decimal that is this number in `f32`, which is also what a reader expects to see.
fn number(x: f32) -> Expr {
    Expr::Const(x.to_string().parse().unwrap_or(f64::from(x)))
}

fn unary(operation: Operation) -> Option<Unary> {
    Some(match operation {
        Operation::Negate => Unary::Neg,
        Operation::Absolute => Unary::Abs,
        Operation::Square => Unary::Square,
        Operation::Exp => Unary::Exp,
        Operation::Log => Unary::Log,
        Operation::Tanh => Unary::Tanh,
        Operation::Sin => Unary::Sin,
        Operation::Cos => Unary::Cos,
        Operation::Atan => Unary::Atan,
        Operation::SquareRoot => Unary::Sqrt,
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn program(operations: &[Operation]) -> Program {
        Program { operations: heapless::Vec::from_slice(operations).unwrap() }
    }

    #[test]
    fn a_program_reads_as_its_law_with_the_numbers_of_the_image() {
        let v = || Expr::Input(0);
        let law = (Expr::Const(22.1) + Expr::Const(8.0) * (Expr::Const(-10.0) * v().abs()).exp())
            * (Expr::Const(50.0) * v()).then(Unary::Tanh);
        let operations = [
            Operation::Input(0),
            Operation::Absolute,
            Operation::Scale(-10.0),
            Operation::Exp,
            Operation::Scale(8.0),
            Operation::Offset(22.1),
            Operation::ScaledInput(0, 50.0),
            Operation::Tanh,
            Operation::Multiply,
        ];
        assert_eq!(expression_of(&program(&operations)), Some(law));
    }

    #[test]
    fn what_is_no_program_is_no_expression() {
        assert_eq!(expression_of(&program(&[Operation::Add])), None);
        assert_eq!(expression_of(&program(&[Operation::Input(0), Operation::Input(0)])), None);
        assert_eq!(expression_of(&program(&[Operation::Input(0), Operation::Sign])), None);
    }
}
