//! What the Frikan trainer and runtime both mean by a friction model: inputs, tables, expressions, effects, image.
//!
//! This crate knows nobody: no file, no recording, no control loop. It says what a model *is* and how it is written
//! down; `frikan-runtime` evaluates it in the drive, `frikan-trainer` makes it and evaluates it a second time, with
//! code of its own, to prove that the drive computes what was trained.
#![no_std]

#[cfg(test)]
extern crate std;

pub mod authentication;
#[cfg(feature = "models")]
pub mod effect;
#[cfg(feature = "elementary")]
pub mod elementary;
#[cfg(feature = "models")]
pub mod expression;
pub mod image;
pub mod input;
pub mod integer_table;
pub mod invalid;
#[cfg(feature = "models")]
pub mod model;
#[cfg(feature = "models")]
pub mod network;
#[cfg(feature = "models")]
pub mod pool;
pub mod table;
pub mod units;
#[cfg(feature = "models")]
pub mod validate;
