//! What the cross-crate tests share.

pub mod models;
pub mod vectors;
