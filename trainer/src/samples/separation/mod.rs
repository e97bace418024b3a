//! Rigid body and friction taken apart: beside a friction that is free to bend, and that may turn over before the velocity.

pub(super) mod bending;
pub(crate) mod lead;
pub mod rigid_body;
