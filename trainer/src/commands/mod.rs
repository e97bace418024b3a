//! One file a subcommand: parse, call, print. No arithmetic here.

pub mod arm;
pub mod check;
pub mod closed_loop;
pub mod diagnose;
pub mod explain;
pub mod export;
pub mod fit;
pub mod fleet;
pub mod init;
mod measurement;
pub mod predict;
pub mod rollout;
pub mod show;
pub mod simulate;
pub mod terminal;
pub mod verify;

pub use terminal::output;
use terminal::progress;
