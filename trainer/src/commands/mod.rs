//! One file a subcommand: parse, call, print.

pub mod diagnose;
pub mod simulate;
