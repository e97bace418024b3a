//! How well a fit determines its parameters.

use crate::numerics::least_squares::{dot, gram, invert_symmetric, ridged_gram};
use nalgebra::DMatrix;
use std::ops::Range;

/// Standard deviations of the parameters over those of linear theory, found on simulated recordings of other seeds than the
/// report's: what choosing the effect and its shape by the same rows adds.
const BEYOND_THEORY: f64 = 1.08;

/// Covariance of the coefficients of whitened columns whose whitened residual is given, wider by the slow colour that whitening
/// leaves. `ridge` is the prior precision of each column over what the rows tell of it. `None` where the columns are dependent.
pub(crate) fn of_whitened(
    columns: &[Vec<f64>],
    residual: &[f64],
    ridge: &[f64],
    runs: &[Range<usize>],
) -> Option<DMatrix<f64>> {
    let inverse = invert_symmetric(&ridged_gram(columns, ridge, runs))?;
    Some(inverse * long_run_variance(residual, runs) * BEYOND_THEORY * BEYOND_THEORY)
}

/// Covariance of the coefficients of a plain fit: what each block pulls at them tells how much they scatter, whatever the
/// residual is inside a block (Liang and Zeger 1986). `None` where the columns are dependent.
pub(crate) fn of_blocks(columns: &[Vec<f64>], residual: &[f64], blocks: &[Vec<Range<usize>>]) -> Option<DMatrix<f64>> {
    let runs: Vec<Range<usize>> = blocks.iter().flatten().cloned().collect();
    let inverse = invert_symmetric(&gram(columns, &runs))?;
    let pulls = DMatrix::from_fn(columns.len(), blocks.len(), |i, block| dot(&columns[i], residual, &blocks[block]));
    let count = blocks.len() as f64;
    let few_blocks = count / (count - 1.0).max(1.0);
    let scatter = &pulls * pulls.transpose() * few_blocks;
    Some(&inverse * scatter * &inverse * BEYOND_THEORY * BEYOND_THEORY)
}

/// Variance of a slow sum of what whitening leaves over that of as many independent rows (Newey and West 1987), at least one:
/// the slow colour that it does not remove.
fn long_run_variance(white: &[f64], runs: &[Range<usize>]) -> f64 {
    const LAGS: usize = 16;
    let lagged = |lag: usize| -> f64 {
        runs.iter()
            .map(|run| &white[run.clone()])
            .flat_map(|run| run.iter().zip(run.iter().skip(lag)))
            .map(|(a, b)| a * b)
            .sum()
    };
    let weight = |lag: usize| 2.0 * (1.0 - lag as f64 / (LAGS + 1) as f64);
    let slow: f64 = (1..=LAGS).map(|lag| weight(lag) * lagged(lag)).sum();
    (1.0 + slow / lagged(0).max(f64::MIN_POSITIVE)).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::least_squares::{least_squares, residual};
    use crate::numerics::random::normal;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;

    #[test]
    fn slow_colour_widens_the_intervals_and_white_noise_does_not() {
        let mut random = ChaCha8Rng::seed_from_u64(4);
        let (runs, mut last) = ([0..6_000, 6_000..20_000], 0.0);
        let white: Vec<f64> = (0..20_000).map(|_| normal(&mut random)).collect();
        let colour = |e: &f64| {
            last = 0.3 * last + e;
            last
        };
        let coloured: Vec<f64> = white.iter().map(colour).collect();
        assert!(long_run_variance(&white, &runs) < 1.1);
        let expected = (1.0 + 0.3) / (1.0 - 0.3);
        assert!((long_run_variance(&coloured, &runs) / expected - 1.0).abs() < 0.15);
    }

    #[test]
    fn what_errs_by_whole_blocks_widens_the_intervals_of_a_plain_fit() {
        const BLOCKS: usize = 24;
        const ROWS: usize = 200;
        let blocks: Vec<Vec<Range<usize>>> =
            (0..BLOCKS).map(|block| std::iter::once(block * ROWS..(block + 1) * ROWS).collect()).collect();
        let runs: Vec<Range<usize>> = blocks.iter().flatten().cloned().collect();
        let column: Vec<f64> = (0..BLOCKS * ROWS).map(|i| 1.0 + (0.37 * i as f64).sin()).collect();
        let mut random = ChaCha8Rng::seed_from_u64(9);
        let deviations: Vec<f64> = (0..200)
            .map(|_| {
                let of_blocks_alone: Vec<f64> = (0..BLOCKS).map(|_| normal(&mut random)).collect();
                let target: Vec<f64> = (0..BLOCKS * ROWS)
                    .map(|i| 2.0 * column[i] + of_blocks_alone[i / ROWS] + 0.3 * normal(&mut random))
                    .collect();
                let columns = std::slice::from_ref(&column);
                let fitted = least_squares(columns, &target, &runs).expect("one column");
                let left = residual(columns, &target, &fitted);
                let covariance = of_blocks(columns, &left, &blocks).expect("one column");
                (fitted[0] - 2.0) / covariance[(0, 0)].sqrt()
            })
            .collect();
        let spread = (deviations.iter().map(|d| d * d).sum::<f64>() / deviations.len() as f64).sqrt();
        assert!((0.8..1.15).contains(&spread), "{spread} stated deviations");
    }
}
