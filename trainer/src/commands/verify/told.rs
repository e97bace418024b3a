//! What every comparison tells.

use serde_json::{Value, json};

use crate::compile::verify::Comparison;
use crate::emulator::{Answer, Footprint};

/// What stepping takes.
#[derive(Default)]
pub(super) struct Cost {
    pub(super) instructions: Option<(u32, u32)>,
    pub(super) flash_bytes: u64,
    pub(super) ram_bytes: u64,
    pub(super) stack_bytes: u64,
}

impl Cost {
    /// On a target, by what it answered and what the program takes beside its image.
    pub(super) fn on_target(answer: &Answer, program: Footprint, image: &[u8]) -> Self {
        Self {
            instructions: answer.instruction_range(),
            flash_bytes: program.flash_bytes + image.len() as u64,
            ram_bytes: program.ram_bytes + u64::from(answer.model_bytes),
            stack_bytes: u64::from(answer.decode_stack_bytes.max(answer.evaluate_stack_bytes)),
        }
    }

    /// For a reader; each line begins with `of`.
    pub(super) fn text(&self, of: &str) -> String {
        let Self { instructions, flash_bytes, ram_bytes, stack_bytes } = self;
        let steps = instructions.map(|(least, most)| {
            format!("{of}{least} to {most} instructions a step, {stack_bytes} bytes of stack at the deepest\n")
        });
        steps.unwrap_or_default() + &format!("{of}{flash_bytes} bytes of flash, {ram_bytes} bytes of RAM\n")
    }

    /// Fewest and most instructions for `--json`.
    pub(super) fn instructions_json(&self) -> Value {
        json!(self.instructions.map(|(min, max)| json!({"min": min, "max": max})))
    }
}

/// `N of N what equal`, or how many agree where not all do.
pub(super) fn line<D>(comparison: &Comparison<D>, what: &str) -> String {
    let word = if comparison.identical() { "equal" } else { "agree" };
    format!("{} of {} {what} {word}", comparison.equal, comparison.compared)
}
