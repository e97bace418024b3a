//! The candidate laws: Coulomb and viscous friction, a formula, a network and its tables; each turned into a model of the joint. Knows
//! not which of them is chosen.

pub(in crate::fit) mod activations;
pub(in crate::fit) mod builder;
pub(in crate::fit) mod formula;
pub(in crate::fit) mod learn;
pub(in crate::fit) mod next_width;
pub(in crate::fit) mod simple;
mod tables;
