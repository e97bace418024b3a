//! A formula as the postfix program of a drive.
//!
//! Constants are folded into the operations that carry one (`Scale`, `Offset`, `ScaledInput`, `PowerOf`), which halves the number
//! of operations of a usual friction law, and the deeper operand of a commutative operator goes first, which keeps the stack shallow.

use frikan_shared::expression::{MAX_OPERATIONS, Operation, Program, ProgramFault};
use thiserror::Error;

use super::formula::{Formula, Function, Operator};

/// Why a formula did not become a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum ProgramError {
    /// The formula needs more operations than a program holds.
    #[error("the formula needs more than {MAX_OPERATIONS} operations")]
    TooLong,
    /// The program does not pass validation: too deep a stack, a constant that is not finite, an input too many.
    #[error("the formula does not make a valid program: {0:?}")]
    Fault(ProgramFault),
}

/// The program of `formula` for a model with `inputs` inputs.
///
/// # Errors
/// [`ProgramError`].
pub fn compile_program(formula: &Formula, inputs: usize) -> Result<Program, ProgramError> {
    let mut operations = Vec::new();
    emit(formula, &mut operations);
    let operations = heapless::Vec::from_slice(&operations).map_err(|_| ProgramError::TooLong)?;
    let program = Program { operations };
    program.check(inputs).map_err(ProgramError::Fault)?;
    Ok(program)
}

/// The formula's value where it reads no input.
fn constant(formula: &Formula) -> Option<f64> {
    (formula.inputs() == 0).then(|| formula.evaluate(&[]))
}

/// Stack that the formula needs.
fn depth(formula: &Formula) -> usize {
    if constant(formula).is_some() {
        return 1;
    }
    match formula {
        Formula::Input(_) | Formula::Constant(_) => 1,
        Formula::Apply(_, argument) => depth(argument),
        Formula::Join(_, left, right) => match (constant(left), constant(right)) {
            (Some(_), _) => depth(right),
            (_, Some(_)) => depth(left),
            _ => depth(left).max(depth(right) + 1),
        },
    }
}

/// An input number past the program's reach is left to the check.
fn channel(index: usize) -> u8 {
    u8::try_from(index).unwrap_or(u8::MAX)
}

fn emit(formula: &Formula, operations: &mut Vec<Operation>) {
    if let Some(value) = constant(formula) {
        operations.push(Operation::Constant(value as f32));
        return;
    }
    match formula {
        Formula::Input(index) => operations.push(Operation::Input(channel(*index))),
        Formula::Constant(value) => operations.push(Operation::Constant(*value as f32)),
        Formula::Apply(function, argument) => {
            emit(argument, operations);
            let operation = match function {
                Function::Negate => Operation::Negate,
                Function::Absolute => Operation::Absolute,
                Function::Square => Operation::Square,
                Function::Reciprocal => Operation::Reciprocal,
                Function::Exp => Operation::Exp,
                Function::Log => Operation::Log,
                Function::Tanh => Operation::Tanh,
                Function::Sin => Operation::Sin,
                Function::Cos => Operation::Cos,
                Function::Atan => Operation::Atan,
                Function::SquareRoot => Operation::SquareRoot,
            };
            push(operation, operations);
        }
        Formula::Join(operator, left, right) => emit_join(*operator, left, right, operations),
    }
}

fn emit_join(operator: Operator, left: &Formula, right: &Formula, operations: &mut Vec<Operation>) {
    match (operator, constant(left), constant(right)) {
        (Operator::Add, Some(summand), _) => with_offset(right, summand, operations),
        (Operator::Add, _, Some(summand)) => with_offset(left, summand, operations),
        (Operator::Subtract, _, Some(subtrahend)) => with_offset(left, -subtrahend, operations),
        (Operator::Subtract, Some(minuend), _) => {
            emit(right, operations);
            operations.extend([Operation::Negate, Operation::Offset(minuend as f32)]);
        }
        (Operator::Multiply, Some(factor), _) => with_factor(right, factor, operations),
        (Operator::Multiply, _, Some(factor)) => with_factor(left, factor, operations),
        (Operator::Divide, _, Some(divisor)) => with_factor(left, 1.0 / divisor, operations),
        (Operator::Divide, Some(dividend), _) => {
            emit(right, operations);
            operations.extend([Operation::Reciprocal, Operation::Scale(dividend as f32)]);
        }
        (Operator::Power, _, Some(exponent)) => {
            emit(left, operations);
            operations.push(Operation::PowerOf(exponent as f32));
        }
        _ => {
            let commutes = matches!(operator, Operator::Add | Operator::Multiply);
            let (first, second) = if commutes && depth(right) > depth(left) { (right, left) } else { (left, right) };
            emit(first, operations);
            emit(second, operations);
            let operation = match operator {
                Operator::Add => Operation::Add,
                Operator::Subtract => Operation::Subtract,
                Operator::Multiply => Operation::Multiply,
                Operator::Divide => Operation::Divide,
                Operator::Power => Operation::Power,
            };
            push(operation, operations);
        }
    }
}

fn with_offset(formula: &Formula, summand: f64, operations: &mut Vec<Operation>) {
    emit(formula, operations);
    operations.push(Operation::Offset(summand as f32));
}

fn with_factor(formula: &Formula, factor: f64, operations: &mut Vec<Operation>) {
    if let Formula::Input(index) = formula {
        operations.push(Operation::ScaledInput(channel(*index), factor as f32));
    } else if let Formula::Apply(Function::Negate, argument) = formula {
        with_factor(argument, -factor, operations);
    } else {
        emit(formula, operations);
        push(Operation::Scale(factor as f32), operations);
    }
}

/// Adds an operation, or makes one of it and an input right before it: to the drive an operation is worth ten instructions.
fn push(operation: Operation, operations: &mut Vec<Operation>) {
    use Operation::{Absolute, Add, AddScaledInput, Input, Negate, Scale, ScaledInput, ScaledMagnitude, Subtract};
    let fused = match (operations.last().copied(), operation) {
        (Some(Input(index)), Absolute) => Some(ScaledMagnitude(index, 1.0)),
        (Some(ScaledInput(index, factor)), Absolute) => Some(ScaledMagnitude(index, factor.abs())),
        (Some(ScaledMagnitude(index, factor)), Negate) => Some(ScaledMagnitude(index, -factor)),
        (Some(ScaledMagnitude(index, factor)), Scale(by)) => Some(ScaledMagnitude(index, factor * by)),
        (Some(ScaledInput(index, factor)), Add) => Some(AddScaledInput(index, factor)),
        (Some(ScaledInput(index, factor)), Subtract) => Some(AddScaledInput(index, -factor)),
        _ => None,
    };
    if fused.is_some() {
        operations.pop();
    }
    operations.push(fused.unwrap_or(operation));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::formula::tests::stribeck_law;
    use frikan_runtime::expression::run;

    #[test]
    fn the_law_of_the_paper_is_eight_operations_and_agrees() {
        let law = stribeck_law();
        let program = compile_program(&law, 1).unwrap();
        println!("{:?}", program.operations);
        assert!(program.operations.len() <= 8);
        for i in -2000..=2000 {
            let v = i as f32 / 1000.0;
            let want = law.evaluate(&[f64::from(v)]);
            assert!((f64::from(run(&program, &[v, 0.0, 0.0, 0.0])) - want).abs() < 2.0e-5, "{v}");
        }
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        assert_eq!(compile_program(&Formula::Input(2), 1), Err(ProgramError::Fault(ProgramFault::NoSuchInput)));
        let long = (0..80).fold(Formula::Input(0), |f, _| f.apply(Function::Tanh));
        assert_eq!(compile_program(&long, 1), Err(ProgramError::TooLong));
        assert_eq!(
            compile_program(&Formula::Input(0).join(Operator::Divide, Formula::Constant(0.0)), 1),
            Err(ProgramError::Fault(ProgramFault::NonFiniteConstant))
        );
    }
}
