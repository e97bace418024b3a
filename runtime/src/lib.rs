//! Evaluates a Frikan friction model in fixed time: no allocation, no panic, no `unsafe`.
//!
//! The arithmetic is written down so that every target computes the same bits: `f32`, each product and each sum rounded by
//! itself in the order of the source, no contraction; elementary functions from [`frikan_shared::elementary`]. NaN at
//! an input gives zero torque; an infinite or out-of-range input holds the value at the nearer end of the trained range.
//! The output is finite and within the model's limit.
#![no_std]

#[cfg(test)]
extern crate std;

pub mod compensator;
pub mod controller;
pub mod drive;
pub mod effects;
pub mod evaluate;
pub mod expression;
pub mod friction;
pub mod integer_table;
pub mod joints;
pub mod network;
pub mod slots;
pub mod supervised;
pub mod table;
mod table_models;
pub mod usable;

#[cfg(test)]
mod test_models;

pub use frikan_shared as shared;
