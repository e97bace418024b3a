//! What all tasks of a list have left.

use super::task::{Done, Failure, Task};
use crate::fleet::{Member, Survey};

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
    /// Tasks in the order of the list, with what they left.
    pub(super) fitted: Vec<(&'a Task, Done)>,
    pub(super) unfitted: Vec<Unfitted<'a>>,
}

/// What an outlier stands out by.
pub(super) fn reasons(member: &Member) -> Vec<&'static str> {
    member.compared.iter().filter(|compared| compared.stands_out).map(|compared| compared.quantity.name()).collect()
}
