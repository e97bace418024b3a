//! What the cross-crate tests share.

pub mod concealed;
pub mod fixtures;
pub mod cost;
pub mod models;
pub mod vectors;
