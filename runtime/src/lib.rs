//! Evaluates a Frikan friction model in fixed time: no allocation, no panic, no `unsafe`.
//!
//! The arithmetic is written down so that every target computes the same bits: `f32`, each product and each sum rounded by
//! itself in the order of the source, no contraction; elementary functions from [`frikan_shared::elementary`]. NaN at
//! an input gives zero torque; an infinite or out-of-range input holds the value at the nearer end of the trained range.
//! The output is finite and within the model's limit.
//!
//! | feature | what it links in |
//! |---|---|
//! | `table` | tables of the velocity, read from the image where it lies ([`in_place`]): the smallest drive |
//! | `integer` | integer tables of the velocity, read where they lie, and a compensator that counts ([`integer`]): the drive without floating-point unit |
//! | `expression`, `network`, `effects` | formulas, networks and correction terms, in images that are decoded to memory |
//! | `supervised` | the supervisor |
//! | `slots` | two slots in flash |
//! | `embedded-storage` | slots on the drivers of that crate |
//! | `auth` | tags behind images |
//! | `nalgebra` | several joints as vectors |
//!
//! All are on by default; [`compensator::Exported`] and the limits are always there. An image that needs what was left out is refused.
#![no_std]

#[cfg(test)]
extern crate std;

/// The example of the README is one that runs.
#[cfg(all(doctest, feature = "table"))]
#[doc = include_str!("../README.md")]
mod readme {}

pub mod bounds;
pub mod compensator;
#[cfg(feature = "supervised")]
pub mod controller;
#[cfg(all(feature = "models", feature = "supervised"))]
pub mod drive;
#[cfg(feature = "models")]
pub mod effects;
#[cfg(feature = "models")]
pub mod friction;
#[cfg(feature = "table")]
pub mod in_place;
#[cfg(feature = "integer")]
pub mod integer;
#[cfg(feature = "nalgebra")]
pub mod joints;
pub mod laws;
pub mod measurement;
#[cfg(feature = "slots")]
pub mod slots;
#[cfg(feature = "supervised")]
pub mod supervised;
#[cfg(feature = "models")]
mod table_models;
pub mod usable;

#[cfg(all(test, feature = "models"))]
mod test_models;

pub use frikan_shared as shared;
#[cfg(any(feature = "models", feature = "integer"))]
pub use laws::integer_table;
pub use laws::table;
#[cfg(feature = "models")]
pub use laws::{evaluate, expression, network};
