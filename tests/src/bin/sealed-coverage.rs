//! How often the 95 % interval of the sealed ratio holds the ratio that a long fresh recording gives:
//! `sealed-coverage [RUNS [FIRST_SEED]]` prints a line a run and the share at the end.

use frikan_tests::sealed_coverage::{Case, EFFECTS, case, prepare};
use rayon::prelude::*;

/// First seed, where none is given.
const SEEDS: u64 = 70_000;

fn main() {
    let mut arguments = std::env::args().skip(1).filter_map(|text| text.parse().ok());
    let (runs, first) = (arguments.next().unwrap_or(40), arguments.next().unwrap_or(SEEDS));
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
