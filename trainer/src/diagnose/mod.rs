//! Which physics is missing: noise, evidence, calibration, naming, localising, proving, advising.
//!
//! Data flow: [`Signals`] -> [`Prepared`] (one filter for all) -> [`Base`] (what is already fitted) -> [`Search`]
//! (evidence for every hypothesis of [`crate::physics`], calibrated against null draws) -> findings.

mod advise;
mod base;
mod blocks;
mod candidates;
mod channel;
mod choice;
mod conclude;
mod confidence;
mod evidence;
mod filter;
mod findings;
mod form;
mod formula;
mod generic;
mod health;
pub mod improve;
mod join;
mod linear;
mod localise;
pub mod model;
mod noise;
mod null;
mod outcome;
mod prepare;
mod prove;
mod random;
mod reference;
mod refine;
mod rollout;
mod round;
mod run;
mod search;
pub mod sentence;
mod settings;
mod signals;
pub mod simulation;
mod strength;
mod traces;

pub use advise::{Advice, Limits, Plan, Question, TOLD_APART_NATS, plan};
pub use base::{Base, BaseKind};
pub use blocks::Lock;
pub use candidates::Label;
pub use channel::Channel;
pub use conclude::{Fitted, Refit, unit_text};
pub use form::Form;
pub use generic::{Factor, Generic};
pub use health::{HealthNote, examine};
pub use join::Unjoinable;
pub use localise::{Location, Region};
pub use noise::Noise;
pub use outcome::{DetectionLimit, Diagnosis, Finding, Score, Verdict};
pub use prepare::Prepared;
pub use prove::Proof;
pub use reference::Reference;
pub use rollout::Rollout;
pub use round::Scored;
pub use run::{Options, Refusal, diagnose};
pub use search::{Accepted, Search, SearchOutcome};
pub use settings::Settings;
pub use signals::Signals;
pub use strength::{Strength, strength};
pub use traces::Traces;
