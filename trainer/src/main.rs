//! The command line `trainer`.
fn main() {}
