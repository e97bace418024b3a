//! What a trained network holds: which edges matter, which can go, how certain its output is, how it is drawn. Knows no optimiser's
//! inside.

pub mod attribution;
pub mod confidence_band;
pub mod graph;
pub mod prune;
