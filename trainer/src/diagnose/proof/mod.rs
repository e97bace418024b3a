//! Refits what was accepted and asks the locked rows. Knows neither names for people nor places.

pub(crate) mod decision;
pub(crate) mod discarded;
pub(crate) mod locked_rows;
pub(crate) mod part;
pub(crate) mod refit;
pub(crate) mod rollout;
