//! What all tasks of a list have left.

use super::task::{Failure, Task};
use crate::fleet::{Member, Survey};

/// A task that left a fit, without the fit itself: of many joints that is more than a memory holds.
#[derive(Clone, Debug)]
pub(super) struct Fitted<'a> {
    pub(super) task: &'a Task,
    /// Why it may not be relied upon, where it may not.
    pub(super) doubt: Option<Failure>,
    /// Codes of what the checks of the recording noticed.
    pub(super) warnings: Vec<String>,
}

/// A task that left no fit.
#[derive(Clone, Debug)]
pub(super) struct Unfitted<'a> {
    pub(super) task: &'a Task,
    /// Why; `None` where it left nothing at all.
    pub(super) failure: Option<Failure>,
}

/// A fleet with all that is told of it.
pub(super) struct Gathered<'a> {
    pub(super) survey: Survey,
    /// In the order of the list.
    pub(super) fitted: Vec<Fitted<'a>>,
    pub(super) unfitted: Vec<Unfitted<'a>>,
}

/// What an outlier stands out by.
pub(super) fn reasons(member: &Member) -> Vec<&'static str> {
    member.compared.iter().filter(|compared| compared.stands_out).map(|compared| compared.quantity.name()).collect()
}
