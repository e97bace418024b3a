//! The model of the residual noise, and what the statistics do when nothing is missing. Knows no candidate by name.

pub(crate) mod autoregression;
pub(crate) mod null_draws;
