//! Frikan trainer: a recording walks through these rooms in one direction,
//! `recording -> checks -> samples -> kan -> law -> compile -> drive`, and `diagnose` asks what a model leaves out.

pub mod checks;
pub mod commands;
pub mod compile;
pub mod diagnose;
pub mod emulator;
pub mod error;
pub mod export;
pub mod figures;
pub mod files;
pub mod fit;
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
pub mod samples;
