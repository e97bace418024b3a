//! One file a subcommand: parse, call, print.

pub(crate) mod explain;
