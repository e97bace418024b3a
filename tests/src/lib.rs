//! What the cross-crate tests share.

pub mod c;
pub mod command;
pub mod concealed;
pub mod cost;
pub mod fixtures;
pub mod laws;
pub mod models;
pub mod paper;
pub mod vectors;

/// Whether `FRIKAN_EXHAUSTIVE=1` asks for every draw, input or row instead of a few.
#[must_use]
pub fn exhaustive() -> bool {
    std::env::var("FRIKAN_EXHAUSTIVE").is_ok_and(|value| value == "1")
}
