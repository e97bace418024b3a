//! P3 and P5 on the page: networks that know no form, and a spline beside them.

use std::fmt::Write;

use frikan_trainer::report::picture::{self, Ink, Mark};

use super::{Files, OVER_VELOCITY, POINTS, PYKAN_CLEAN_RMSE, PYKAN_NOISY_R2, PYKAN_SECONDS, series};
use crate::paper::network::{Learnt, learn, learn_with, noisy_r2, short_options};
use crate::paper::spline_peer::{COEFFICIENTS, at_equal_count};
use crate::paper::{Effort, JOINTS, NOISE, friction, median};

pub(super) fn networks(page: &mut String, files: &mut Files, effort: Effort) -> std::fmt::Result {
    writeln!(
        page,
        "\n## P3: unknown form, clean\n\n`[1,5,1]`, 10 cells, order 3. Test RMSE in N m after a third, two thirds and all of the \
         training: the median over {} seeds, and\nthe worst. Published: R2 close to 1.\n\n\
         | joint | 1/3 | 2/3 | all | worst seed | seconds, worst | pykan, 300 steps | pykan, seconds |\n|---|---|---|---|---|---|---|---|",
        effort.seeds
    )?;
    for j in 0..JOINTS.len() {
        let all: Vec<Learnt> = (0..effort.seeds).map(|seed| learn(j, 0.0, seed)).collect();
        let of = |stage: usize| all.iter().map(|learnt| learnt.rmse[stage]).collect::<Vec<_>>();
        let [third, two_thirds, whole] = [0, 1, 2].map(|stage| median(&of(stage)));
        let worst = largest(of(2).into_iter());
        let seconds = largest(all.iter().map(|learnt| learnt.seconds));
        writeln!(
            page,
            "| {} | {third:.4} | {two_thirds:.4} | {whole:.4} | {worst:.4} | {seconds:.2} | {} | {PYKAN_SECONDS} |",
            j + 1,
            PYKAN_CLEAN_RMSE[j]
        )?;
        files.push((format!("paper/clean-joint-{}.svg", j + 1), stages(j, &all[0])));
    }
    writeln!(
        page,
        "\n![Joint 1, clean, while it was trained](paper/clean-joint-1.svg)\n\nAll joints: [1](paper/clean-joint-1.svg), [2](paper/clean-joint-2.svg), [3](paper/clean-joint-3.svg), [4](paper/clean-joint-4.svg), [5](paper/clean-joint-5.svg), [6](paper/clean-joint-6.svg)."
    )?;
    writeln!(
        page,
        "\nThe same network after a short training, of one start and 8 steps: the worst of {} seeds. The last column is pykan's time for 300\n\
         steps over the longest of ours.\n\n| joint | RMSE, worst | pykan, 300 steps | seconds, worst | times as fast |\n|---|---|---|---|---|",
        effort.seeds
    )?;
    for (j, pykan) in PYKAN_CLEAN_RMSE.into_iter().enumerate() {
        let all: Vec<Learnt> = (0..effort.seeds).map(|seed| learn_with(j, 0.0, seed, &short_options(seed))).collect();
        let rmse = largest(all.iter().map(|learnt| learnt.rmse[2]));
        let seconds = largest(all.iter().map(|learnt| learnt.seconds));
        writeln!(page, "| {} | {rmse:.4} | {pykan} | {seconds:.2} | {:.0} |", j + 1, PYKAN_SECONDS / seconds)?;
    }
    writeln!(
        page,
        "\n## P5: unknown form under noise\n\nStandard deviation λ/2 of the range. R2 against the clean truth, {} seeds. Published: \
         close to 1.\n\n| joint | λ | median | worst | pykan, 100 steps |\n|---|---|---|---|---|",
        effort.seeds
    )?;
    for (j, noise) in NOISE.into_iter().enumerate() {
        let all = noisy_r2(j, effort.seeds);
        let worst = all.iter().copied().fold(f64::INFINITY, f64::min);
        writeln!(
            page,
            "| {} | {:.0} % | {:.5} | {worst:.5} | {} |",
            j + 1,
            100.0 * noise,
            median(&all),
            PYKAN_NOISY_R2[j]
        )?;
        files.push((format!("paper/noisy-joint-{}.svg", j + 1), stages(j, &learn(j, noise / 2.0, 0))));
    }
    writeln!(page, "\n![Joint 6 under 20 % noise](paper/noisy-joint-6.svg)")?;
    equal_count(page, effort)
}

fn equal_count(page: &mut String, effort: Effort) -> std::fmt::Result {
    writeln!(
        page,
        "\n## A network and a spline with as many coefficients\n\n`[1,1]` with {COEFFICIENTS} coefficients, against a least-squares cubic spline \
         of {COEFFICIENTS} whose knots are equal steps of asinh (the crowding\nthat leaves least on the samples). RMSE against the clean truth in N m, \
         median of {} seeds, and the largest ratio of the two.\n\n\
         | joint | network, clean | spline, clean | ratio | network, λ = 5 % | spline, λ = 5 % | ratio |\n|---|---|---|---|---|---|---|",
        effort.seeds
    )?;
    for j in 0..JOINTS.len() {
        let row = [0.0, 0.025].map(|share| {
            let all: Vec<[f64; 2]> = (0..effort.seeds).map(|seed| at_equal_count(j, share, seed)).collect();
            let [network, spline] = [0, 1].map(|which| median(&all.iter().map(|pair| pair[which]).collect::<Vec<_>>()));
            format!("{network:.4} | {spline:.4} | {:.3}", largest(all.iter().map(|[n, s]| n / s)))
        });
        writeln!(page, "| {} | {} |", j + 1, row.join(" | "))?;
    }
    Ok(())
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, f64::max)
}

/// Samples with the network after parts of its training.
fn stages(joint: usize, learnt: &Learnt) -> String {
    let at = |i: usize| -1.0 + 2.0 * i as f64 / (POINTS - 1) as f64;
    let curve = |share: f64| {
        let network = learnt.fit.network_at(share);
        Mark::Line((0..POINTS).map(|i| [at(i), network.evaluate(&[at(i)])]).collect())
    };
    let dots = learnt.samples.velocity.iter().zip(&learnt.samples.noisy).map(|(v, f)| [*v, *f]).collect();
    let truth = (0..POINTS).map(|i| [at(i), friction(JOINTS[joint], at(i))]).collect();
    picture::curves(
        OVER_VELOCITY,
        &[
            series(Mark::Dots(dots), Ink::Data, "samples"),
            series(Mark::Line(truth), Ink::Data, "truth"),
            series(curve(1.0 / 3.0), Ink::Three, "1/3"),
            series(curve(2.0 / 3.0), Ink::Two, "2/3"),
            series(curve(1.0), Ink::One, "all of the training"),
        ],
    )
}
