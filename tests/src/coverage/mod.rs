//! How often a stated interval holds what it is of.

pub mod law;
pub mod sealed;
