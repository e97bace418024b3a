//! The commanded motion of a recording. Knows no joint and no drive.

pub mod campaign;
pub mod motion;
mod moves;
pub mod reference;
