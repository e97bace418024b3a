//! How often the 95 % intervals of `fit` hold the constants of simulated joints, and how often the law is the right one:
//! `law-coverage [SEEDS [FIRST_SEED]]` prints a table; `law-coverage SEEDS FIRST_SEED elbow` that of the elbow at 250 Hz alone.

use frikan_tests::law_coverage::{Constant, Printed, Setting, Truth, printed};

/// First seed, where none is given.
const SEEDS: u64 = 80_000;
/// Samples a second, Hz.
const RATES: [f64; 2] = [250.0, 1000.0];
/// Bits of one turn of the encoder; the elbow of the fixtures has the last.
const BITS: [u32; 4] = [13, 16, 20, 21];

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |at: usize| arguments.get(at).and_then(|text| text.parse().ok());
    let (seeds, first) = (number(0).unwrap_or(20), number(1).unwrap_or(SEEDS));
    let is_short = arguments.get(2).is_some_and(|word| word == "elbow");
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
