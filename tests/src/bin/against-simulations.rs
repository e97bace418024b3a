//! Compares recordings with simulations that hold none, one or all of what the real joint hides, writes the page.

use clap::Parser;
use frikan_tests::concealed::simulated::{Comparison, Group, report, run};
use frikan_tests::concealed::{Case, Hidden, PAIRS, WITHOUT_TORQUE, page};
use frikan_trainer::diagnose::BaseKind;
use frikan_trainer::plant::{CATALOGUE, NoiseKind};

/// Compares recordings with simulations and reports what is named.
#[derive(Parser)]
struct Arguments {
    /// Recordings of each kind of noise of a joint that hides nothing.
    #[arg(long, default_value_t = 2)]
    controls: u64,
    /// Recordings of each effect and of each pair of them, for every way in which a simulator can hold them.
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

/// How much larger than the others an effect is of which a shorter simulation holds all.
const LARGE: f64 = 10.0;

fn main() -> std::io::Result<()> {
    let arguments = Arguments::parse();
    let results: Vec<_> = page::counted(&comparisons(&arguments), |comparison| {
        run(comparison).map_err(|error| eprintln!("{comparison:?}: {error}")).ok()
    });
    let results: Vec<_> = results.into_iter().flatten().collect();
    page::put(&report(&results, &page::command("against-simulations")), arguments.output.as_deref())
}

fn comparisons(arguments: &Arguments) -> Vec<Comparison> {
    let mut comparisons = Vec::new();
    let mut add = |group: Group, hidden: Hidden, noise: NoiseKind, count: u64| {
        let case = Case { hidden, noise, base: BaseKind::Reference, seed: 0 };
        comparisons.extend((0..count).map(|_| Comparison { group, case: case.clone() }));
    };
    NoiseKind::ALL.into_iter().for_each(|noise| add(Group::Control, Hidden::Nothing, noise, arguments.controls));
    // Non-centrality goes with the square of the amplitude.
    let [strength, large] = [1.0, LARGE * LARGE].map(|times| times * arguments.strength);
    for entry in CATALOGUE.iter().filter(|entry| !WITHOUT_TORQUE.contains(&entry.name)) {
        add(Group::Held, Hidden::Effect(entry.name, strength), NoiseKind::Coloured, arguments.seeds);
        add(Group::Missing, Hidden::Effect(entry.name, strength), NoiseKind::Coloured, arguments.seeds);
        // What goes with the clock goes on once the simulation has ended.
        if !["slow_drift", "transient_event"].contains(&entry.name) {
            add(Group::ShorterHeld, Hidden::Effect(entry.name, large), NoiseKind::Coloured, arguments.seeds);
        }
    }
    for (first, second) in PAIRS {
        for group in [Group::HeldAndMissing, Group::ShorterHeldAndMissing] {
            add(group, Hidden::Pair(first, second, strength), NoiseKind::Coloured, arguments.seeds);
        }
    }
    page::seeds(arguments.first_seed).zip(&mut comparisons).for_each(|(seed, comparison)| comparison.case.seed = seed);
    comparisons
}
