//! What the cross-crate tests share.

pub mod command;
pub mod concealed;
pub mod cost;
pub mod fixtures;
pub mod laws;
pub mod models;
pub mod paper;
pub mod vectors;

/// Whether `FRIKAN_EXHAUSTIVE=1` asks for every draw instead of a few.
#[must_use]
pub fn exhaustive() -> bool {
    std::env::var("FRIKAN_EXHAUSTIVE").is_ok_and(|value| value == "1")
}

/// Whether the long forms of the tests were asked for, by `FRIKAN_EXHAUSTIVE=1`.
#[must_use]
pub fn exhaustive() -> bool {
    std::env::var_os("FRIKAN_EXHAUSTIVE").is_some_and(|value| value == "1")
}
