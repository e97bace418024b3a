//! What is told of a table of integers.

use frikan_runtime::integer::Units;

use crate::compile::cost::FloatStep;
use crate::compile::integers::CountedError;

/// A table of integers in an image, and what it is worth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegerSummary {
    /// Name of the drive that it was made for.
    pub target: &'static str,
    /// Cells of the table.
    pub cells: usize,
    /// What a count is worth: of the velocity in its unit, of the torque in that of the friction.
    pub counts: Units,
    /// How far what the drive puts out is off the law that was chosen.
    pub error: CountedError,
    /// Instructions of a step of the drive, where they are documented.
    pub instructions: Option<u32>,
    /// What a step takes with the law in floats.
    pub in_floats: Option<FloatStep>,
}
