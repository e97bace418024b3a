//! The stack machine of symbolic laws.

use frikan_shared::elementary;
use frikan_shared::expression::{MAX_DEPTH, Operation, Program};
use frikan_shared::model::MAX_INPUTS;

/// Runs a program over inputs that are already held to their trained ranges.
///
/// The top of the stack is kept apart from the others; a validated program never reads a value that it did not push.
/// The number of instructions depends on the program alone. The result may be infinite or NaN; the caller limits it.
#[must_use]
#[inline(always)]
pub fn run(program: &Program, inputs: &[f32; MAX_INPUTS]) -> f32 {
    let mut stack = Stack { below: [0.0; MAX_DEPTH], depth: 0 };
    let mut top = 0.0f32;
    for operation in &program.operations {
        match *operation {
            Operation::Input(index) => {
                stack.push(top);
                top = input(inputs, index);
            }
            Operation::ScaledInput(index, factor) => {
                stack.push(top);
                top = input(inputs, index) * factor;
            }
            Operation::Constant(constant) => {
                stack.push(top);
                top = constant;
            }
            Operation::Scale(factor) => top *= factor,
            Operation::Offset(summand) => top += summand,
            Operation::Add => top += stack.pop(),
            Operation::Subtract => top = stack.pop() - top,
            Operation::Multiply => top *= stack.pop(),
            Operation::Divide => top = stack.pop() / top,
            Operation::Minimum => {
                let second = stack.pop();
                top = if second < top { second } else { top };
            }
            Operation::Maximum => {
                let second = stack.pop();
                top = if second > top { second } else { top };
            }
            Operation::Power => top = elementary::power(stack.pop(), top),
            Operation::PowerOf(exponent) => top = elementary::power(top, exponent),
            Operation::Negate => top = -top,
            Operation::Absolute => top = top.abs(),
            Operation::Square => top *= top,
            Operation::Reciprocal => top = 1.0 / top,
            Operation::Exp => top = elementary::exp(top),
            Operation::Log => top = elementary::log(top),
            Operation::Tanh => top = elementary::tanh(top),
            Operation::Sin => top = elementary::sin(top),
            Operation::Cos => top = elementary::cos(top),
            Operation::Atan => top = elementary::atan(top),
            Operation::SquareRoot => top = elementary::square_root(top),
            Operation::Sign => top = elementary::sign(top),
            Operation::ScaledMagnitude(index, factor) => {
                stack.push(top);
                top = input(inputs, index).abs() * factor;
            }
            Operation::AddScaledInput(index, factor) => top += input(inputs, index) * factor,
        }
    }
    top
}

/// What lies below the top of the stack.
struct Stack {
    below: [f32; MAX_DEPTH],
    depth: usize,
}

// Sizes are powers of two: the masks change no index of a validated program and leave nothing to check.
const _: () = assert!(MAX_DEPTH.is_power_of_two() && MAX_INPUTS.is_power_of_two());

impl Stack {
    #[inline(always)]
    fn push(&mut self, value: f32) {
        self.below[self.depth & (MAX_DEPTH - 1)] = value;
        self.depth = self.depth.wrapping_add(1);
    }

    #[inline(always)]
    fn pop(&mut self) -> f32 {
        self.depth = self.depth.wrapping_sub(1);
        self.below[self.depth & (MAX_DEPTH - 1)]
    }
}

#[inline(always)]
fn input(inputs: &[f32; MAX_INPUTS], index: u8) -> f32 {
    inputs[usize::from(index) & (MAX_INPUTS - 1)]
}
