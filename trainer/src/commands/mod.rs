//! One file a subcommand: parse, call, print.

pub mod explain;
pub mod simulate;
