//! Where a command meets its caller: files and standard output, signs of life, the shell.

pub mod configuration;
pub mod output;
pub(crate) mod progress;
pub mod shell;
