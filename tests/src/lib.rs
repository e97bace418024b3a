//! What the cross-crate tests share.

pub mod c;
pub mod command;
pub mod concealed;
pub mod cost;
pub mod fixtures;
pub mod models;
pub mod vectors;
