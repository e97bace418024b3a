//! Adds effects to other people's recordings and writes what the diagnosis makes of them.

use clap::Parser;
use frikan_tests::concealed::page;
use frikan_tests::concealed::semi_real::{self, ADDED, Added, ByItself, Found, Real, SHARES, listed};
use frikan_tests::recordings_folder;
use rayon::prelude::*;

/// Adds effects to every recording of the folder beside the repository, at several shares of the torque.
#[derive(Parser)]
struct Arguments {
    /// Only recordings whose names begin so.
    #[arg(long, value_delimiter = ',')]
    only: Vec<String>,
    /// Shares of the torque (0..1), root mean square.
    #[arg(long, value_delimiter = ',', default_values_t = SHARES)]
    shares: Vec<f64>,
    /// Where the Markdown goes; standard output when absent.
    #[arg(short, long)]
    output: Option<std::path::PathBuf>,
}

fn main() -> std::io::Result<()> {
    let arguments = Arguments::parse();
    let wanted = |name: &str| arguments.only.is_empty() || arguments.only.iter().any(|only| name.starts_with(only));
    let files: Vec<_> = listed(&recordings_folder()).into_iter().filter(|(name, _)| wanted(name)).collect();
    let loaded = files.par_iter().map(|(name, files)| {
        let real = Real::load(name, files)?;
        let before = real.found()?;
        Ok((real, before))
    });
    let loaded: Vec<Result<(Real, Found), String>> = loaded.collect();
    let (mut reals, mut refused) = (Vec::new(), Vec::new());
    for ((name, _), one) in files.into_iter().zip(loaded) {
        match one {
            Ok(real) => reals.push(real),
            Err(reason) => refused.push((name, reason)),
        }
    }
    let by_itself = reals.par_iter().map(|(real, before)| {
        let why = |effect: &'static str| real.refuses(effect, before).map(|why| (effect, why));
        let left_out = ADDED.into_iter().filter_map(why).collect();
        ByItself { name: real.name.clone(), told: before.told(), left_out }
    });
    let by_itself: Vec<ByItself> = by_itself.collect();
    let mut jobs = Vec::new();
    for ((real, before), ByItself { left_out, .. }) in reals.iter().zip(&by_itself) {
        for effect in ADDED.into_iter().filter(|effect| left_out.iter().all(|(left, _)| left != effect)) {
            jobs.extend(arguments.shares.iter().map(|share| (real, before, effect, *share)));
        }
    }
    let results = page::counted(&jobs, |(real, before, effect, share)| {
        real.add(effect, *share, before).map_err(|error| format!("{} with {effect}: {error}", real.name))
    });
    let added: Vec<Added> = results.into_iter().filter_map(|one| one.map_err(|e| eprintln!("{e}")).ok()).collect();
    let text = semi_real::page(&page::command("real-additions"), &added, &by_itself, &refused);
    page::put(&text, arguments.output.as_deref())
}
