//! Least squares for the constants of one structure. Knows no other structure and does not say whether this one is good.

pub mod problem;
pub mod projection;
