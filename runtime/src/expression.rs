//! The stack machine of symbolic laws.

use frikan_shared::elementary;
use frikan_shared::expression::{MAX_DEPTH, Operation, Program};
use frikan_shared::model::MAX_INPUTS;

/// Runs a program over inputs that are already held to their trained ranges.
///
/// The top of the stack is kept apart from the others; a validated program never reads a value that it did not push.
/// The number of instructions depends on the program alone. The result may be infinite or NaN; the caller limits it.
#[must_use]
pub fn run(program: &Program, inputs: &[f32; MAX_INPUTS]) -> f32 {
    // Sizes are powers of two: the masks change no index of a validated program and leave nothing to check.
    const { assert!(MAX_DEPTH.is_power_of_two() && MAX_INPUTS.is_power_of_two()) };
    let mut below = [0.0f32; MAX_DEPTH];
    let mut depth = 0usize;
    let mut top = 0.0f32;
    for operation in &program.operations {
        match *operation {
            Operation::Input(_) | Operation::ScaledInput(_, _) | Operation::Constant(_) => {
                below[depth & (MAX_DEPTH - 1)] = top;
                depth = depth.wrapping_add(1);
            }
            Operation::Add
            | Operation::Subtract
            | Operation::Multiply
            | Operation::Divide
            | Operation::Minimum
            | Operation::Maximum
            | Operation::Power => depth = depth.wrapping_sub(1),
            _ => {}
        }
        let second = below[depth & (MAX_DEPTH - 1)];
        top = match *operation {
            Operation::Input(index) => inputs[usize::from(index) & (MAX_INPUTS - 1)],
            Operation::ScaledInput(index, factor) => inputs[usize::from(index) & (MAX_INPUTS - 1)] * factor,
            Operation::Constant(constant) => constant,
            Operation::Scale(factor) => top * factor,
            Operation::Offset(summand) => top + summand,
            Operation::Add => second + top,
            Operation::Subtract => second - top,
            Operation::Multiply => second * top,
            Operation::Divide => second / top,
            Operation::Minimum => {
                if second < top {
                    second
                } else {
                    top
                }
            }
            Operation::Maximum => {
                if second > top {
                    second
                } else {
                    top
                }
            }
            Operation::Power => elementary::power(second, top),
            Operation::PowerOf(exponent) => elementary::power(top, exponent),
            Operation::Negate => -top,
            Operation::Absolute => top.abs(),
            Operation::Square => top * top,
            Operation::Reciprocal => 1.0 / top,
            Operation::Exp => elementary::exp(top),
            Operation::Log => elementary::log(top),
            Operation::Tanh => elementary::tanh(top),
            Operation::Sin => elementary::sin(top),
            Operation::Cos => elementary::cos(top),
            Operation::Atan => elementary::atan(top),
            Operation::SquareRoot => elementary::square_root(top),
            Operation::Sign => elementary::sign(top),
        };
    }
    top
}
