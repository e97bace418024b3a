//! From a network or a law to the model that a drive evaluates, with a certified error.
//!
//! A law arrives as a [`formula::Formula`], leaves as cells, programs and tables of a [`frikan_shared::model::Model`], and is
//! proved against the runtime by [`verify`], with an evaluator of its own in [`mod@reference`]; what a control loop calls, effects, memory
//! and limits included, is proved by [`steps`].

pub mod cells;
pub mod cost;
pub mod effects;
pub mod formula;
pub mod host_model;
pub mod improved;
pub mod integers;
pub mod interval;
pub mod networks;
pub mod profile;
pub mod program;
pub mod reference;
pub mod series;
pub mod steps;
pub mod tables;
pub mod verify;
