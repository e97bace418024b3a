//! Measures what training costs and writes `docs/training-cost.md`.

use std::fmt::Write as _;
use std::path::Path;
use std::slice::from_ref;
use std::time::Instant;

use frikan_tests::paper::network::{learn_with, noisy_options};
use frikan_tests::paper::{self, JOINTS};
use frikan_tests::training_cost::{CELLS, EVALUATIONS, GROUP};
use frikan_trainer::error::{Error, Result, codes};
use frikan_trainer::figures::digits;
use frikan_trainer::files::write_whole;
use frikan_trainer::kan::{Blocks, Dataset, FitOptions, Random, fit};

/// Where the page goes, from the root of the repository.
const PAGE: &str = "docs/training-cost.md";

/// Agreement with the clean truth to which the time is taken.
const AGREEMENTS: [f64; 3] = [0.9999, 0.99999, 0.999_999];

/// Numbers of steps of the trainings that are timed.
const STEPS: [usize; 12] = [1, 2, 3, 4, 5, 6, 8, 10, 15, 20, 40, 60];

/// Samples of the trainings of growing size, and the steps of each.
const SAMPLES: [usize; 4] = [10_000, 100_000, 1_000_000, 10_000_000];
const LONG_STEPS: usize = 3;

const HEAD: &str = "\
# What training costs

Written by `cargo run --release -p frikan-tests --bin training-cost` after `cargo bench -p frikan-tests`; nothing here is
typed by hand. Times are those of the machine that wrote the page (two hyperthreads of one core): ratios travel, seconds do
not.
";

fn main() -> Result<()> {
    let mut page = String::from(HEAD);
    append_evaluations(&mut page)?;
    append_agreements(&mut page);
    append_samples(&mut page);
    write_whole(Path::new(PAGE), page.as_bytes())?;
    print!("{page}");
    Ok(())
}

/// Loss and gradient, as the benchmark left its figures.
fn append_evaluations(page: &mut String) -> Result<()> {
    page.push_str(
        "\n## One evaluation of loss and gradient, one thread\n\n\
         | network | samples | evaluations per s | ns a sample |\n|---|---|---|---|\n",
    );
    let cells = CELLS.map(|cells| (format!("{cells} cells"), 10_000));
    for (name, samples) in EVALUATIONS.map(|(shape, samples)| (shape.to_owned(), samples)).into_iter().chain(cells) {
        let path = format!("target/criterion/{GROUP}/{name}/{samples}/new/estimates.json");
        let text = std::fs::read_to_string(&path).map_err(|error| Error::from_io(Path::new(&path), &error))?;
        let estimates: serde_json::Value = serde_json::from_str(&text)
            .map_err(|error| Error::new(&codes::INPUT_OUTPUT, error.to_string()).in_file(&path))?;
        let nanoseconds = estimates["median"]["point_estimate"].as_f64().unwrap_or(f64::NAN);
        let shape = if name.ends_with("cells") { format!("[1,5,1], {name}") } else { name };
        let (rate, share) = (digits(1e9 / nanoseconds), digits(nanoseconds / samples as f64));
        // Writing to a string cannot fail, here and below.
        let _ = writeln!(page, "| {shape} | {samples} | {rate} | {share} |");
    }
    Ok(())
}

/// Time and steps of `[1,5,1]` to an agreement with the clean truth, on the paper's clean samples.
fn append_agreements(page: &mut String) {
    page.push_str(
        "\n## Time to an agreement with the truth\n\n\
         `[1,5,1]`, 1000 clean samples, one start, damped Gauss-Newton; R2 on 2000 other samples. pykan 0.2.8 takes 64 s for its\n\
         300 steps on a machine of this class and ends between .99984 and .999999.\n\n\
         | joint | R2 .9999 | R2 .99999 | R2 .999999 |\n|---|---|---|---|\n",
    );
    for joint in 0..JOINTS.len() {
        let trainings: Vec<(usize, f64, f64)> = STEPS
            .into_iter()
            .map(|steps| {
                let learnt = learn_with(joint, 0.0, 0, &FitOptions { steps, ..noisy_options(0) });
                (steps, learnt.seconds, learnt.r2)
            })
            .collect();
        let reached = AGREEMENTS.map(|agreement| {
            let first = trainings.iter().find(|(_, _, r2)| *r2 >= agreement);
            first.map_or_else(|| "-".to_owned(), |(steps, s, _)| format!("{} s, {steps} steps", digits(*s)))
        });
        let _ = writeln!(page, "| {} | {} |", joint + 1, reached.join(" | "));
    }
}

/// Training on ever more samples.
fn append_samples(page: &mut String) {
    let _ = write!(
        page,
        "\n## Samples\n\n`[1,5,1]`, joint 1, 5 % noise, {LONG_STEPS} steps of damped Gauss-Newton, two threads.\n\n\
         | samples | s | ns a sample and step | rmse against the truth, N m |\n|---|---|---|---|\n",
    );
    for count in SAMPLES {
        let samples = paper::samples(JOINTS[0], count, 0.05, &mut Random::new(5, 0));
        let blocks = Blocks::default();
        let data =
            Dataset { inputs: from_ref(&samples.velocity), target: &samples.noisy, linear: &[], blocks: &blocks };
        let options = FitOptions { steps: LONG_STEPS, tolerance: 0.0, ..noisy_options(0) };
        let start = Instant::now();
        let learnt = fit(&data, &options, &|_| ()).expect("usable samples");
        let seconds = start.elapsed().as_secs_f64();
        let steps = learnt.convergence.steps.max(1);
        let points: Vec<f64> = (0..4000).map(|i| -1.0 + (f64::from(i) + 0.5) / 2000.0).collect();
        let error = |(v, y): (&f64, f64)| (y - paper::friction(JOINTS[0], *v)).powi(2);
        let predicted = learnt.network.evaluate_columns(from_ref(&points));
        let square: f64 = points.iter().zip(predicted).map(error).sum::<f64>() / points.len() as f64;
        let each = digits(1e9 * seconds / (count * steps) as f64);
        let _ = writeln!(page, "| {count} | {} | {each} | {} |", digits(seconds), digits(square.sqrt()));
    }
}
