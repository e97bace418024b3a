//! The postfix program of a symbolic law.
//!
//! A program is a list of operations on a stack of `f32`. Every operation is carried out in `f32`, in the order of the
//! program, each product and each sum rounded by itself. What may go wrong (a missing operand, a stack too deep, an input that is
//! not there) is refused when an image is decoded, so that evaluation cannot fail.

use serde::{Deserialize, Serialize};

pub use crate::invalid::ProgramFault;

/// Most operations of a program.
pub const MAX_OPERATIONS: usize = 64;

/// Deepest stack of a program; a power of two, so that a stack index is a mask.
pub const MAX_DEPTH: usize = 8;

/// One operation. `a` is the top of the stack, `b` the value below it.
///
/// Elementary functions are those of [`crate::elementary`], which are defined for every bit pattern.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Operation {
    /// Pushes an input, held to its trained range.
    Input(u8),
    /// Pushes an input, held to its trained range, times a factor.
    ScaledInput(u8, f32),
    /// Pushes a constant.
    Constant(f32),
    /// `a * factor`.
    Scale(f32),
    /// `a + summand`.
    Offset(f32),
    /// `b + a`.
    Add,
    /// `b - a`.
    Subtract,
    /// `b * a`.
    Multiply,
    /// `b / a`.
    Divide,
    /// The smaller of `b` and `a`; `a` where either is NaN.
    Minimum,
    /// The larger of `b` and `a`; `a` where either is NaN.
    Maximum,
    /// `|b|^a`.
    Power,
    /// `|a|^exponent`.
    PowerOf(f32),
    /// `-a`.
    Negate,
    /// `|a|`.
    Absolute,
    /// `a * a`.
    Square,
    /// `1 / a`.
    Reciprocal,
    /// `exp(a)`.
    Exp,
    /// `ln |a|`.
    Log,
    /// `tanh(a)`.
    Tanh,
    /// `sin(a)`.
    Sin,
    /// `cos(a)`.
    Cos,
    /// `atan(a)`.
    Atan,
    /// `sqrt |a|`.
    SquareRoot,
    /// `-1`, `0` or `1` with the sign of `a`; `0` for NaN.
    Sign,
    /// Pushes the magnitude of an input, held to its trained range, times a factor.
    ScaledMagnitude(u8, f32),
    /// `a` plus an input, held to its trained range, times a factor.
    AddScaledInput(u8, f32),
}

impl Operation {
    /// Values that the operation takes from the stack, and the constant that it carries, if any.
    fn demands(self) -> (usize, Option<f32>) {
        match self {
            Self::Input(_) => (0, None),
            Self::ScaledInput(_, constant) | Self::ScaledMagnitude(_, constant) | Self::Constant(constant) => {
                (0, Some(constant))
            }
            Self::Scale(constant)
            | Self::Offset(constant)
            | Self::PowerOf(constant)
            | Self::AddScaledInput(_, constant) => (1, Some(constant)),
            Self::Add
            | Self::Subtract
            | Self::Multiply
            | Self::Divide
            | Self::Minimum
            | Self::Maximum
            | Self::Power => (2, None),
            Self::Negate
            | Self::Absolute
            | Self::Square
            | Self::Reciprocal
            | Self::Exp
            | Self::Log
            | Self::Tanh
            | Self::Sin
            | Self::Cos
            | Self::Atan
            | Self::SquareRoot
            | Self::Sign => (1, None),
        }
    }
}

/// A law as a postfix program.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Program {
    /// The operations in order.
    pub operations: heapless::Vec<Operation, MAX_OPERATIONS>,
}

impl Program {
    /// Checks that the program can be evaluated with `inputs` inputs.
    ///
    /// # Errors
    /// The first fault, in the order of the operations.
    pub fn check(&self, inputs: usize) -> Result<(), ProgramFault> {
        let mut depth = 0usize;
        for &operation in &self.operations {
            if let Operation::Input(index)
            | Operation::ScaledInput(index, _)
            | Operation::ScaledMagnitude(index, _)
            | Operation::AddScaledInput(index, _) = operation
                && usize::from(index) >= inputs
            {
                return Err(ProgramFault::NoSuchInput);
            }
            let (taken, constant) = operation.demands();
            if constant.is_some_and(|constant| !constant.is_finite()) {
                return Err(ProgramFault::NonFiniteConstant);
            }
            // Every operation leaves exactly one value.
            depth = depth.checked_sub(taken).ok_or(ProgramFault::MissingOperand)? + 1;
            if depth > MAX_DEPTH {
                return Err(ProgramFault::TooDeep);
            }
        }
        match depth {
            0 => Err(ProgramFault::Empty),
            1 => Ok(()),
            _ => Err(ProgramFault::ValuesLeft),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(operations: &[Operation], inputs: usize) -> Result<(), ProgramFault> {
        Program { operations: heapless::Vec::from_slice(operations).unwrap() }.check(inputs)
    }

    #[test]
    fn faults_are_told_apart() {
        use Operation::*;
        assert_eq!(check(&[], 1), Err(ProgramFault::Empty));
        assert_eq!(check(&[Input(0), Tanh], 1), Ok(()));
        assert_eq!(check(&[Input(1), Tanh], 1), Err(ProgramFault::NoSuchInput));
        assert_eq!(check(&[Input(0), Add], 1), Err(ProgramFault::MissingOperand));
        assert_eq!(check(&[Input(0), Input(0)], 1), Err(ProgramFault::ValuesLeft));
        assert_eq!(check(&[Input(0), Scale(f32::NAN)], 1), Err(ProgramFault::NonFiniteConstant));
        assert_eq!(check(&[Input(0); MAX_DEPTH + 1], 1), Err(ProgramFault::TooDeep));
    }
}
