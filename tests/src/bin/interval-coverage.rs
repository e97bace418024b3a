//! How often 95 % intervals hold what they are of.
//!
//! `interval-coverage law [SEEDS [FIRST_SEED [elbow]]]`: those of `fit` and the constants of simulated joints, and how often its law is the right one; of
//! all settings, or of the elbow at 250 Hz alone.
//! `interval-coverage sealed [RUNS [FIRST_SEED]]`: that of the sealed ratio and the ratio that a long fresh recording gives.

use frikan_tests::coverage::law::{Constant, Printed, Setting, Truth, printed};
use frikan_tests::coverage::sealed::{Case, EFFECTS, case, prepare};
use rayon::prelude::*;

/// First seeds, where none is given.
const SEED_OF_LAWS: u64 = 80_000;
const SEED_OF_SEALED: u64 = 70_000;
/// Samples a second, Hz.
const RATES: [f64; 2] = [250.0, 1000.0];
/// Bits of one turn of the encoder; the elbow of the fixtures has the last.
const BITS: [u32; 4] = [13, 16, 20, 21];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |at: usize| arguments.get(at).and_then(|text| text.parse().ok());
    match arguments.first().map(String::as_str) {
        Some("law") => {
            let is_short = arguments.get(3).is_some_and(|word| word == "elbow");
            laws(number(1).unwrap_or(20), number(2).unwrap_or(SEED_OF_LAWS), is_short);
        }
        Some("sealed") => sealed(number(1).unwrap_or(40), number(2).unwrap_or(SEED_OF_SEALED)),
        _ => eprintln!("interval-coverage law|sealed [COUNT [FIRST_SEED]]"),
    }
}

fn laws(seeds: u64, first: u64, is_short: bool) {
    let mut all = Vec::new();
    for truth in Truth::ALL {
        for rate_hz in RATES {
            for bits in BITS {
                let is_elbow = truth == Truth::Exponential && rate_hz == RATES[0] && bits == BITS[3];
                if is_short && !is_elbow {
                    continue;
                }
                let setting = Setting { truth, rate_hz, bits };
                let runs: Vec<Printed> =
                    (first..first + seeds).filter_map(|seed| printed(setting, seed).ok()).collect();
                println!("{truth:?}, {rate_hz} Hz, {bits} bits: {} fitted", runs.len());
                runs.iter().for_each(|run| println!("    {}{}", if run.is_right { "" } else { "WRONG " }, run.law));
                tell(&runs);
                all.extend(runs);
            }
        }
    }
    println!("all");
    tell(&all);
}

/// The share of right structures, and for each constant how often it is held, in all laws and in the right ones, and its values.
fn tell(runs: &[Printed]) {
    let right: Vec<&Printed> = runs.iter().filter(|run| run.is_right).collect();
    println!("  right structure {} of {}", right.len(), runs.len());
    let mut names: Vec<&str> = runs.iter().flat_map(|run| &run.constants).map(|found| found.name.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    for name in names {
        let of = |run: &'_ Printed| run.constants.iter().find(|found| found.name == name).cloned();
        let every: Vec<Constant> = runs.iter().filter_map(of).collect();
        let held = |found: &[Constant]| found.iter().filter(|found| found.is_held()).count();
        let in_right: Vec<Constant> = right.iter().filter_map(|run| of(run)).collect();
        let mut values: Vec<f64> = every.iter().map(|found| found.value).collect();
        values.sort_by(f64::total_cmp);
        println!(
            "  {name:<22} held {:>3} of {:>3}, {:>3} of {:>3} in right laws; {:.4} {:.4} {:.4} for {}",
            held(&every),
            every.len(),
            held(&in_right),
            in_right.len(),
            values[0],
            values[values.len() / 2],
            values[values.len() - 1],
            every[0].truth,
        );
    }
}

fn sealed(runs: u64, first: u64) {
    let folder = tempfile::tempdir().expect("there is room for recordings");
    prepare(folder.path());
    println!("effect seed | sealed low high | fresh stretches");
    let cases: Vec<Case> = (first..first + runs)
        .into_par_iter()
        .filter_map(|seed| {
            let effect = EFFECTS[(seed % EFFECTS.len() as u64) as usize];
            let own = folder.path().join(seed.to_string());
            std::fs::create_dir(&own).expect("it is new");
            let case = case(&own, effect, seed);
            std::fs::remove_dir_all(&own).expect("it is our own");
            if let Some(Case { ratio, ci95: [low, high], fresh, stretches }) = &case {
                println!("{effect} {seed} | {ratio:.4} {low:.4} {high:.4} | {fresh:.4} {stretches}");
            }
            case
        })
        .collect();
    let held = cases.iter().filter(|case| case.is_held()).count();
    println!("held {held} of {} ({:.1} %)", cases.len(), 100.0 * held as f64 / cases.len().max(1) as f64);
}
