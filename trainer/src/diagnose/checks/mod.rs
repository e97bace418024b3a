//! What is wrong with the measurement itself, before any physics. Knows no candidate and makes no sentence.

pub(crate) mod command_beyond_limit;
pub(crate) mod health;
pub(crate) mod note;
pub(crate) mod unit_or_sign;
