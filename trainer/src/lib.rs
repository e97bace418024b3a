//! Frikan trainer: a recording walks through these rooms in one direction,
//! `recording -> checks -> samples -> kan -> law -> compile -> drive`, and `diagnose` asks what a model leaves out.

pub mod actuator;
pub mod arm;
pub mod bam;
pub mod checks;
pub mod commands;
pub mod compile;
mod csv_text;
pub mod diagnose;
mod did_you_mean;
pub mod emulator;
pub mod error;
pub mod export;
pub mod figures;
pub mod files;
pub mod fit;
pub mod fleet;
mod inference;
pub mod joint;
pub mod kan;
pub mod key;
pub mod law;
mod markup;
pub mod numerics;
pub mod parameter;
pub mod physics;
pub mod plant;
pub mod recording;
pub mod report;
pub mod rig;
mod robot;
pub mod rollout;
pub mod samples;
pub mod servo;
pub mod workflow;

pub use workflow::diagnose::diagnose;
pub use workflow::fit::fit;
