//! Which effects a recording asks for: candidates as columns at the recorded and at the simulated states, weighed by `inference`.
//!
//! With a simulation the rows of both stand in one model: every candidate has a common coefficient, a random effect on both, and one of
//! the recording alone. What the simulation shows as well goes into the common one and is not missing.

pub(crate) mod answer;
pub(crate) mod beside_simulation;
pub(crate) mod candidates;
pub(crate) mod delay;
pub(crate) mod inferred;
pub(crate) mod predicted_blocks;
pub(crate) mod refined;
pub(crate) mod side;
mod size;
pub(crate) mod weighing;
