//! `trainer plan`, `run` and `gather`: a fit for each recording of a fleet, as tasks for any engine that counts, and one table of all.

pub mod gather;
mod gathered;
pub mod plan;
pub mod run;
mod stamp;
mod table;
mod task;
mod told;
