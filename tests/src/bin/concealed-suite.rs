//! The proof on concealed effects: hides every effect at several strengths, runs the diagnosis, writes the tables.

use clap::Parser;
use frikan_tests::concealed::afterwards::{Afterwards, FEED_FORWARD};
use frikan_tests::concealed::summary::Row;
use frikan_tests::concealed::tables::report;
use frikan_tests::concealed::{Case, Hidden, PAIRS, advised, afterwards, page, run, servo};
use frikan_trainer::diagnose::BaseKind;
use frikan_trainer::plant::{CATALOGUE, NoiseKind, OUTSIDE};
use rayon::prelude::*;

/// Hides effects in simulated recordings and reports what the diagnosis makes of them.
#[derive(Parser)]
struct Arguments {
    /// Controls of each of the five kinds.
    #[arg(long, default_value_t = 4)]
    controls: u64,
    /// Controls of each kind when the diagnosis starts from a spline of nine coefficients, and from a Stribeck law.
    #[arg(long, default_value_t = 0)]
    base_controls: u64,
    /// Runs of each effect and strength.
    #[arg(long, default_value_t = 1)]
    seeds: u64,
    /// Runs of each structure outside the catalogue.
    #[arg(long, default_value_t = 1)]
    outside: u64,
    /// Runs of each pair of effects.
    #[arg(long, default_value_t = 1)]
    pairs: u64,
    /// Non-centralities.
    #[arg(long, value_delimiter = ',', default_value = "80")]
    strengths: Vec<f64>,
    /// Every case has a seed of its own, from ten thousand times this on: thresholds were fixed on seeds below a million.
    #[arg(long, default_value_t = 1000)]
    first_seed: u64,
    /// Only effects of these names.
    #[arg(long, value_delimiter = ',')]
    only: Vec<String>,
    /// Runs of each effect when the diagnosis starts from a spline of nine coefficients, and from a Stribeck law.
    #[arg(long, default_value_t = 0)]
    bases: u64,
    /// Non-centralities of those.
    #[arg(long, value_delimiter = ',', default_value = "80")]
    base_strengths: Vec<f64>,
    /// Seeds of the other trajectories of the same joint; the confounded recordings go with them.
    #[arg(long, default_value_t = 0)]
    afterwards: u64,
    /// Draws of each effect, and eight times as many controls, of the same joint with a torque column and under each kind of actuator that
    /// records none.
    #[arg(long, default_value_t = 0)]
    servo: u64,
    /// Title of the page.
    #[arg(long, default_value = "Effects concealed in simulated recordings")]
    title: String,
    /// Where the Markdown goes; standard output when absent.
    #[arg(short, long)]
    output: Option<std::path::PathBuf>,
}

fn main() -> std::io::Result<()> {
    let arguments = Arguments::parse();
    let cases = cases(&arguments);
    let outcomes: Vec<Result<Row, String>> = page::counted(&cases, |case| {
        run(case).map(|outcome| Row::of(&outcome)).map_err(|error| format!("{case}: {error}"))
    });
    let (rows, errors): (Vec<_>, Vec<_>) = outcomes.into_iter().partition(Result::is_ok);
    let rows: Vec<Row> = rows.into_iter().flatten().collect();
    let errors: Vec<String> = errors.into_iter().filter_map(Result::err).collect();
    let mut text = report(&arguments.title, &rows, &errors, &page::command("concealed-suite"));
    if arguments.afterwards > 0 {
        text += &beyond(&arguments);
    }
    if arguments.servo > 0 {
        text += &servos(&arguments, cases.len());
    }
    page::put(&text, arguments.output.as_deref())
}

/// What goes beyond one recording each: other trajectories, confounded recordings with the proposed motion.
fn beyond(arguments: &Arguments) -> String {
    const STRENGTH: f64 = 80.0;
    let seeds = arguments.first_seed..arguments.first_seed + arguments.afterwards;
    let jobs: Vec<(&'static str, u64)> =
        FEED_FORWARD.iter().flat_map(|effect| seeds.clone().map(|seed| (*effect, seed))).collect();
    let later: Vec<Afterwards> =
        jobs.par_iter().filter_map(|(effect, seed)| said(afterwards::run(effect, STRENGTH, *seed))).collect();
    let confounded: Vec<_> = advised::pairs()
        .into_par_iter()
        .filter_map(|case| said(advised::run(&case, arguments.first_seed)).map(|advised| (case, advised)))
        .collect();
    afterwards::table(&later) + &advised::table(&confounded)
}

/// The same joint with a torque column and under actuators, on seeds behind those of `before` cases.
fn servos(arguments: &Arguments, before: usize) -> String {
    let hidden =
        servo::effects().filter(|name| arguments.only.is_empty() || arguments.only.iter().any(|only| only == name));
    let draws = hidden.map(Some).chain([None; 8]).flat_map(|hidden| (0..arguments.servo).map(move |_| hidden));
    let seeded: Vec<_> = page::seeds(arguments.first_seed).skip(before).zip(draws).collect();
    let told = page::counted(&seeded, |(seed, hidden)| servo::draw(*hidden, *seed, &servo::Source::ALL));
    servo::table(&told.into_iter().flatten().filter_map(said).collect::<Vec<_>>())
}

/// The result, or nothing and what was wrong on standard error.
fn said<T>(result: Result<T, String>) -> Option<T> {
    result.map_err(|error| eprintln!("{error}")).ok()
}

fn cases(arguments: &Arguments) -> Vec<Case> {
    let mut cases = Vec::new();
    let wanted = |name: &str| arguments.only.is_empty() || arguments.only.iter().any(|only| only == name);
    let mut add = |hidden: Hidden, noise, base, count| {
        cases.extend((0..count).map(|_| Case { hidden: hidden.clone(), noise, base, seed: 0 }));
    };
    let plain = BaseKind::CoulombViscous;
    let to_conceal = arguments.strengths.iter().map(|strength| (plain, *strength, arguments.seeds));
    let of_base = |base| arguments.base_strengths.iter().map(move |strength| (base, *strength, arguments.bases));
    let others = [BaseKind::Spline, BaseKind::Reference];
    for (base, strength, count) in to_conceal.chain(others.into_iter().flat_map(of_base)) {
        let effects = CATALOGUE.iter().filter(|entry| entry.name != "clock_gaps" && wanted(entry.name));
        // A base that holds the effect misses nothing.
        for entry in effects.filter(|entry| base == plain || entry.name != "stribeck") {
            add(Hidden::Effect(entry.name, strength), NoiseKind::Coloured, base, count);
        }
    }
    let of_others = others.map(|base| (base, arguments.base_controls));
    for (base, count) in std::iter::once((plain, arguments.controls)).chain(of_others) {
        NoiseKind::ALL.into_iter().for_each(|noise| add(Hidden::Nothing, noise, base, count));
    }
    for entry in OUTSIDE.iter().filter(|entry| wanted(entry.name)) {
        add(Hidden::Effect(entry.name, 80.0), NoiseKind::Coloured, plain, arguments.outside);
    }
    for (first, second) in PAIRS {
        add(Hidden::Pair(first, second, 150.0), NoiseKind::Coloured, plain, arguments.pairs);
    }
    page::seeds(arguments.first_seed).zip(&mut cases).for_each(|(seed, case)| case.seed = seed);
    cases
}
