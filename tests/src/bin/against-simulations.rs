//! Compares recordings with simulations that hold none, one or all of what the real joint hides, writes the page.

use clap::Parser;
use frikan_tests::concealed::simulated::{report, run};
use frikan_tests::concealed::{Case, Hidden, PAIRS, WITHOUT_TORQUE, page};
use frikan_trainer::diagnose::BaseKind;
use frikan_trainer::plant::{CATALOGUE, NoiseKind};

/// Compares recordings with simulations and reports what is named.
#[derive(Parser)]
struct Arguments {
    /// Recordings of each kind of noise of a joint that hides nothing.
    #[arg(long, default_value_t = 2)]
    controls: u64,
    /// Recordings of each effect that the simulator holds, as many that it lacks, and of each pair of which it holds one.
    #[arg(long, default_value_t = 1)]
    seeds: u64,
    /// Non-centrality of each hidden effect.
    #[arg(long, default_value_t = 80.0)]
    strength: f64,
    /// Every case has a seed of its own, from ten thousand times this on.
    #[arg(long, default_value_t = 1000)]
    first_seed: u64,
    /// Where the Markdown goes; standard output when absent.
    #[arg(short, long)]
    output: Option<std::path::PathBuf>,
}

fn main() -> std::io::Result<()> {
    let arguments = Arguments::parse();
    let results: Vec<_> = page::counted(&cases(&arguments), |(case, held)| {
        run(case, *held).map_err(|error| eprintln!("{case:?}: {error}")).ok()
    });
    let results: Vec<_> = results.into_iter().flatten().collect();
    page::put(&report(&results, &page::command("against-simulations")), arguments.output.as_deref())
}

/// Every recording with the number of its effects that the simulator holds.
fn cases(arguments: &Arguments) -> Vec<(Case, usize)> {
    let mut cases = Vec::new();
    let mut add = |hidden: Hidden, noise: NoiseKind, held: usize, count: u64| {
        let case = Case { hidden, noise, base: BaseKind::Reference, seed: 0 };
        cases.extend((0..count).map(|_| (case.clone(), held)));
    };
    NoiseKind::ALL.into_iter().for_each(|noise| add(Hidden::Nothing, noise, 0, arguments.controls));
    for entry in CATALOGUE.iter().filter(|entry| !WITHOUT_TORQUE.contains(&entry.name)) {
        for held in [1, 0] {
            let hidden = Hidden::Effect(entry.name, arguments.strength);
            add(hidden, NoiseKind::Coloured, held, arguments.seeds);
        }
    }
    for (first, second) in PAIRS {
        add(Hidden::Pair(first, second, arguments.strength), NoiseKind::Coloured, 1, arguments.seeds);
    }
    page::seeds(arguments.first_seed).zip(&mut cases).for_each(|(seed, (case, _))| case.seed = seed);
    cases
}
