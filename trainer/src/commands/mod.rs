//! One file a subcommand: parse, call, print. No arithmetic here.

pub mod closed_loop;
pub mod diagnose;
pub mod explain;
pub mod export;
pub mod fit;
pub mod init;
mod measurement;
pub mod output;
pub mod predict;
mod progress;
pub mod show;
pub mod simulate;
pub mod verify;
