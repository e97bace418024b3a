//! Which physics is missing where a recording and a model of its joint differ.
//!
//! A recording walks through the rooms in one direction, and `run` tells the story:
//! `measurement` -> `preparation` -> `checks` -> `comparison` (what is already modelled) -> `hypotheses` and `noise` -> `evidence` ->
//! `search` -> `proof` -> `answer` -> `advice`. Knows no file, no command line and no picture.

pub(crate) mod advice;
pub(crate) mod answer;
pub(crate) mod checks;
pub(crate) mod comparison;
mod confirmed;
pub(crate) mod evidence;
pub(crate) mod hypotheses;
pub(crate) mod infer;
pub(crate) mod measurement;
pub(crate) mod noise;
pub(crate) mod preparation;
pub(crate) mod proof;
mod realign;
mod relock;
pub(crate) mod request;
pub(crate) mod run;
pub(crate) mod search;

pub use advice::{Limits, Plan, Question, plan};
pub use answer::location::Location;
pub use answer::outcome::{DetectionLimit, Diagnosis, Estimate, Evidence, Finding, Given, Score, Verdict};
pub use answer::region::{Region, Side};
pub use answer::sealed::{Residuals, SealedScore};
pub use answer::traces::{Traces, WorstLocked};
pub use checks::note::{HealthNote, Observation};
pub use comparison::columns::BaseKind;
pub use comparison::reference::{Comparison, Reference};
pub use comparison::{from_model as model, simulation};
pub use evidence::strength::{Strength, strength};
pub use hypotheses::channel::Channel;
pub use hypotheses::fitted::Fitted;
pub use hypotheses::function_form::Form;
pub use hypotheses::label::Label;
pub use hypotheses::unnamed::{Factor, Generic};
pub use measurement::join::Unjoinable;
pub use measurement::signals::Signals;
pub use noise::autoregression::Noise;
pub use preparation::rows::Lock;
pub use preparation::states::Prepared;
pub use proof::discarded::Discarded;
pub use proof::locked_rows::Proof;
pub use proof::refit::Refit;
pub use proof::rollout::{Motion, Rollout};
pub use request::{Options, Refusal};
pub use run::{diagnose, diagnose_beside, learn_simulation};
pub use search::scored::Scored;
pub use search::thresholds::{AMBIGUITY_MARGIN_NATS, Settings};
