//! What every suite of cases shares: seeds of its own, progress on standard error, and a page that names its command.

use rayon::prelude::*;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Seeds that one run may take.
const SEEDS_OF_A_RUN: u64 = 10_000;

/// A seed for every case of a run: cases that share one would share their noise, and with it their luck.
pub fn seeds(first: u64) -> impl Iterator<Item = u64> {
    first * SEEDS_OF_A_RUN..
}

/// What comes of every case, in their order.
pub fn counted<C: Sync, R: Send>(cases: &[C], run: impl Fn(&C) -> R + Sync) -> Vec<R> {
    let done = AtomicUsize::new(0);
    let counting = |case| {
        let result = run(case);
        let count = done.fetch_add(1, Ordering::Relaxed) + 1;
        if count.is_multiple_of(20) {
            eprintln!("{count} of {} cases", cases.len());
        }
        result
    };
    cases.par_iter().map(counting).collect()
}

/// The command line with which a program of this package was called, as cargo runs it.
pub fn command(program: &str) -> String {
    let quoted = |argument: String| if argument.contains(' ') { format!("'{argument}'") } else { argument };
    let arguments: Vec<String> = std::env::args().skip(1).map(quoted).collect();
    format!("cargo run --release -p frikan-tests --bin {program} -- {}", arguments.join(" "))
}

/// Writes a page, or prints it where no file is given.
///
/// # Errors
/// What keeps the file from being written.
pub fn put(page: &str, output: Option<&Path>) -> std::io::Result<()> {
    match output {
        Some(path) => std::fs::write(path, page),
        None => {
            println!("{page}");
            Ok(())
        }
    }
}
