//! What a network is: nodes, edges, splines, and its value and slopes at a sample. Knows no data and no training.

pub mod architecture;
pub mod dense;
pub mod error;
pub mod evaluation;
pub mod knots;
pub mod layers;
pub mod random;
pub mod refinement;
pub mod spline;
pub mod trace;
