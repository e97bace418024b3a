//! What every comparison tells.

use crate::compile::verify::Comparison;

/// What stepping takes.
#[derive(Default)]
pub(super) struct Cost {
    pub(super) instructions: Option<(u32, u32)>,
    pub(super) flash_bytes: u64,
    pub(super) ram_bytes: u64,
    pub(super) stack_bytes: u64,
}

/// `N of N what equal`, or how many agree where not all do.
pub(super) fn line<D>(comparison: &Comparison<D>, what: &str) -> String {
    let word = if comparison.identical() { "equal" } else { "agree" };
    format!("{} of {} {what} {word}", comparison.equal, comparison.compared)
}
