//! Diagnoses recordings by equations that this project's simulator does not share, writes `docs/second-opinion.md`.

use clap::Parser;
use frikan_tests::concealed::page;
use frikan_tests::second_opinion::page::{Row, report};
use frikan_tests::second_opinion::{Case, cases, run};
use std::path::{Path, PathBuf};

/// Diagnoses recordings by equations that the simulator does not share and reports what is named.
#[derive(Parser)]
struct Arguments {
    /// First seed; it shifts every random detail of every recording.
    #[arg(long, default_value_t = 1)]
    first_seed: u64,
    /// Recordings of every case.
    #[arg(long, default_value_t = 1)]
    seeds: u64,
    /// Only cases of these effects, parts (singles, controls, faults, clock, unnamed, pairs, halves, simulations, models) or names.
    #[arg(long, value_delimiter = ',')]
    only: Vec<String>,
    /// Folder in which the files of every case are kept.
    #[arg(long, value_name = "FOLDER")]
    keep: Option<PathBuf>,
    /// Where the Markdown goes; standard output when absent.
    #[arg(short, long)]
    output: Option<PathBuf>,
}

/// A case with its place among all, and a seed.
struct Job<'a> {
    number: usize,
    case: &'a Case,
    seed: u64,
}

fn main() -> std::io::Result<()> {
    let arguments = Arguments::parse();
    let cases = cases();
    let is_wanted = |case: &Case| arguments.only.is_empty() || arguments.only.iter().any(|word| case.is_meant(word));
    if let Some(word) = arguments.only.iter().find(|word| !cases.iter().any(|case| case.is_meant(word))) {
        return Err(std::io::Error::other(format!("no case is of {word}")));
    }
    let seeds = arguments.first_seed..arguments.first_seed + arguments.seeds;
    let wanted = cases.iter().enumerate().filter(|(_, case)| is_wanted(case));
    let jobs: Vec<Job> =
        wanted.flat_map(|(number, case)| seeds.clone().map(move |seed| Job { number, case, seed })).collect();
    let results = page::counted(&jobs, |job| {
        answered(job, arguments.keep.as_deref())
            .map_err(|error| format!("{}, seed {}: {error}", job.case.name, job.seed))
    });
    let (rows, errors): (Vec<_>, Vec<_>) = results.into_iter().partition(Result::is_ok);
    let rows: Vec<Row> = rows.into_iter().flatten().collect();
    let errors: Vec<String> = errors.into_iter().filter_map(Result::err).collect();
    page::put(&report(&rows, &errors, &page::command("second-opinion")), arguments.output.as_deref())
}

fn answered(job: &Job, keep: Option<&Path>) -> Result<Row, String> {
    let material = job.case.record(job.seed, job.number);
    let answer = match keep {
        Some(folder) => {
            let folder = folder.join(format!("{}-seed-{}", job.case.name, job.seed));
            std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
            run::diagnose(&material, &folder)
        }
        None => run::diagnose(&material, tempfile::tempdir().map_err(|error| error.to_string())?.path()),
    }?;
    Ok(Row::of(job.case, job.seed, material.description, answer))
}
