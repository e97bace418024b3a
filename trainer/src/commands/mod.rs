//! One file a subcommand: parse, call, print.

pub mod simulate;
