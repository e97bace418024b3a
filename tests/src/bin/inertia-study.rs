//! How well the inertia is found for encoders of 10 to 20 bits, 100 Hz to 5 kHz and 0.5 to 20 % of torque noise:
//! `inertia-study [DRAWS]` prints a table.

use frikan_tests::inertia::{BITS, Found, NOISE, RATES, Setting, found};

/// First seed.
const SEEDS: u64 = 40_000;

fn main() {
    let draws = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(10);
    println!("bits rate_Hz noise_% | right inside_% median_error_% worst_error_%, of {draws} draws");
    let (mut right, mut inside, mut all) = (0, 0, 0);
    for bits in BITS {
        for rate_hz in RATES {
            for noise in NOISE {
                let setting = Setting { bits, rate_hz, noise };
                let draws: Vec<Found> = (SEEDS..SEEDS + draws).filter_map(|seed| found(setting, seed).ok()).collect();
                let mut errors: Vec<f64> = draws.iter().map(|draw| draw.error).collect();
                errors.sort_by(|a, b| a.abs().total_cmp(&b.abs()));
                let held = draws.iter().filter(|draw| draw.inside).count();
                let (count, good) = (draws.len(), draws.iter().filter(|draw| draw.is_right()).count());
                let percent = |error: Option<&f64>| 100.0 * error.copied().unwrap_or(f64::NAN);
                println!(
                    "{bits:>4} {rate_hz:>7} {:>7.1} | {good:>5} {:>8.0} {:>14.2} {:>13.2}",
                    100.0 * noise,
                    100.0 * held as f64 / count.max(1) as f64,
                    percent(errors.get(count / 2)),
                    percent(errors.last()),
                );
                (right, inside, all) = (right + good, inside + held, all + count);
            }
        }
    }
    println!("right {right} of {all}, inside their intervals {inside}");
}
