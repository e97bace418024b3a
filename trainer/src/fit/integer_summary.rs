//! What is told of a table of integers.

use frikan_runtime::integer::Units;

use crate::compile::cost::FloatStep;
use crate::compile::integers::{CountedError, q_format};
use crate::law::significant;

/// Significant digits of figures in sentences.
const DIGITS: usize = 3;

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

impl IntegerSummary {
    /// What it is, what counts it has, and how far it is off the law, each in half a sentence; `units` are those of velocity and friction.
    #[must_use]
    pub fn told(&self, [of_velocity, unit]: [&str; 2]) -> [String; 3] {
        let Self { target, cells, counts, error, instructions, in_floats } = self;
        let count = |count: f32, unit: &str| {
            let format = q_format(count).map_or(String::new(), |format| format!("{format}, "));
            format!("{format}counts of {} {unit}", significant(f64::from(count), DIGITS))
        };
        let instructions =
            instructions.map_or(String::new(), |number| format!(" takes {number} instructions a step on {target}"));
        let in_floats = in_floats.map_or(String::new(), |step| {
            let [least, most] = step.instructions;
            format!("; in floats a {} takes {least} to {most} there (docs/drive-cost.md)", step.row)
        });
        [
            format!("a table of {cells} cells{instructions}{in_floats}"),
            format!("velocity in {}, torque in {}", count(counts.velocity, of_velocity), count(counts.torque, unit)),
            format!(
                "at every one of {} counts within {} {unit} of the law ({} % of the largest friction), furthest at {} {of_velocity}; root mean square {} {unit}",
                error.counts,
                significant(error.largest, DIGITS),
                significant(100.0 * error.share(), DIGITS),
                significant(error.at, DIGITS),
                significant(error.rms, DIGITS),
            ),
        ]
    }
}
