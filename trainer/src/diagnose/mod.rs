//! Which physics is missing: noise, evidence, calibration, naming, localising, proving, advising.
//!
//! Data flow: [`Signals`] -> [`Prepared`] (one filter for all) -> [`Base`] (what is already fitted) -> [`Search`]
//! (evidence for every hypothesis of [`crate::physics`], calibrated against null draws) -> findings.

mod base;
mod candidates;
mod evidence;
mod filter;
mod linear;
mod noise;
mod null;
mod prepare;
mod random;
mod refine;
mod search;
mod signals;

pub use base::{Base, BaseKind};
pub use candidates::{Channel, Factor, Generic, Label};
pub use prepare::{Lock, Prepared};
pub use search::{Accepted, Scored, Search, SearchOutcome, Settings};
pub use signals::Signals;
