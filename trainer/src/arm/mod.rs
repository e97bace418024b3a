//! Whole arms: the chain of a URDF, its dynamics, and what recordings of all joints say of its bodies and of the friction of each
//! joint. Knows no files and no commands.

pub mod base;
pub mod chain;
pub mod clearance;
pub mod dynamics;
pub mod excitation;
pub mod fit;
pub mod identify;
pub mod motion;
mod plan;
mod system;
