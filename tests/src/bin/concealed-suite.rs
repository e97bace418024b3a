//! The proof on concealed effects: hides every effect at several strengths, runs the diagnosis, writes the tables.

use clap::Parser;
use frikan_tests::concealed::summary::{Row, report};
use frikan_tests::concealed::{Case, Hidden, run};
use frikan_trainer::diagnose::BaseKind;
use frikan_trainer::plant::{CATALOGUE, NoiseKind, OUTSIDE};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Hides effects in simulated recordings and reports what the diagnosis makes of them.
#[derive(Parser)]
struct Arguments {
    /// Controls of each of the five kinds.
    #[arg(long, default_value_t = 4)]
    controls: u64,
    /// Seeds of each effect and strength.
    #[arg(long, default_value_t = 1)]
    seeds: u64,
    /// Seeds of each structure outside the catalogue.
    #[arg(long, default_value_t = 1)]
    outside: u64,
    /// Seeds of each pair of effects.
    #[arg(long, default_value_t = 1)]
    pairs: u64,
    /// Non-centralities.
    #[arg(long, value_delimiter = ',', default_value = "80")]
    strengths: Vec<f64>,
    /// First seed: thresholds were fixed on seeds below 1000.
    #[arg(long, default_value_t = 1000)]
    first_seed: u64,
    /// Only effects of these names.
    #[arg(long, value_delimiter = ',')]
    only: Vec<String>,
    /// Also from a spline base of nine coefficients.
    #[arg(long)]
    spline: bool,
    /// Where the Markdown goes; standard output when absent.
    #[arg(short, long)]
    output: Option<std::path::PathBuf>,
}

/// Pairs whose members are far apart in the catalogue.
const PAIRS: [(&str, &str); 6] = [
    ("stribeck", "load_friction"),
    ("coupling", "torque_offset"),
    ("inertia_error", "contact"),
    ("presliding", "warm_up"),
    ("position_ripple", "slow_drift"),
    ("frictional_lag", "spring"),
];

fn main() -> std::io::Result<()> {
    let arguments = Arguments::parse();
    let cases = cases(&arguments);
    let done = AtomicUsize::new(0);
    let outcomes: Vec<Result<Row, String>> = cases
        .par_iter()
        .map(|case| {
            let row = run(case).map(|outcome| Row::of(&outcome)).map_err(|error| format!("{case:?}: {error}"));
            let count = done.fetch_add(1, Ordering::Relaxed) + 1;
            if count.is_multiple_of(20) {
                eprintln!("{count} of {} cases", cases.len());
            }
            row
        })
        .collect();
    let (rows, errors): (Vec<_>, Vec<_>) = outcomes.into_iter().partition(Result::is_ok);
    let rows: Vec<Row> = rows.into_iter().flatten().collect();
    let errors: Vec<String> = errors.into_iter().filter_map(Result::err).collect();
    let command = std::env::args().skip(1).collect::<Vec<_>>().join(" ");
    let text =
        report(&rows, &errors, &format!("cargo run --release -p frikan-tests --bin concealed-suite -- {command}"));
    match &arguments.output {
        Some(path) => std::fs::write(path, text),
        None => {
            println!("{text}");
            Ok(())
        }
    }
}

fn cases(arguments: &Arguments) -> Vec<Case> {
    let mut cases = Vec::new();
    let seeds = |count: u64| arguments.first_seed..arguments.first_seed + count;
    let mut bases = vec![BaseKind::CoulombViscous];
    if arguments.spline {
        bases.push(BaseKind::Spline);
    }
    let wanted = |name: &str| arguments.only.is_empty() || arguments.only.iter().any(|only| only == name);
    let case = |hidden: Hidden, noise, base, seed| Case { hidden, noise, base, seed };
    for base in bases {
        for seed in seeds(arguments.controls) {
            cases.extend(NoiseKind::ALL.map(|noise| case(Hidden::Nothing, noise, base, seed)));
        }
        for strength in &arguments.strengths {
            for entry in CATALOGUE.iter().filter(|entry| entry.name != "clock_gaps" && wanted(entry.name)) {
                cases.extend(
                    seeds(arguments.seeds)
                        .map(|seed| case(Hidden::Effect(entry.name, *strength), NoiseKind::Coloured, base, seed)),
                );
            }
        }
        for entry in OUTSIDE.iter().filter(|entry| wanted(entry.name)) {
            cases.extend(
                seeds(arguments.outside)
                    .map(|seed| case(Hidden::Effect(entry.name, 80.0), NoiseKind::Coloured, base, seed)),
            );
        }
        for (first, second) in PAIRS {
            cases.extend(
                seeds(arguments.pairs)
                    .map(|seed| case(Hidden::Pair(first, second, 150.0), NoiseKind::Coloured, base, seed)),
            );
        }
    }
    cases
}
