//! What is kept of a recording as it is read: its text, or its numbers; of a long one the columns in use, and the rows that a memory holds.

mod in_use;
mod thinning;

pub(super) use in_use::InUse;
pub(crate) use thinning::STRETCH_ROWS;
pub(super) use thinning::Thinning;

/// What is kept of a recording.
#[derive(Clone, Copy, Debug)]
pub(super) enum Keep<'a> {
    /// All of its text beside its numbers, so that it can be written again.
    Text,
    /// Its numbers, of a long one those in use, and the text of the first rows, and of columns whose numbers a double does not hold to the last digit.
    Numbers(InUse<'a>),
}
