//! Accepts one candidate after the other while the evidence lasts. Knows no locked row.

pub(crate) mod accepted;
pub(crate) mod choice;
pub(crate) mod forward_backward;
pub(crate) mod round;
pub(crate) mod scored;
pub(crate) mod setup;
pub(crate) mod thresholds;
