//! Errors of least squares by leaving out blocks of rows in turn, which allows for noise that is correlated within blocks, that is stronger in
//! some rows than in others, and for few blocks (MacKinnon, Nielsen & Webb 2023).

use super::least_squares::{gram, moments, solve_symmetric};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// Blocks over which residuals may be correlated, for standard errors. Chosen by judgement: half as many leave the spread of a constant to
/// chance, and noise is correlated over less than a fortieth of a recording.
pub(crate) const ERROR_BLOCKS: usize = 40;
/// Least energy that a column is given beside that of its rows, as a share: in directions of less nothing is identified.
const LEAST_ENERGY_SHARE: f64 = 1e-9;

/// Blocks of nearly the same length.
pub(crate) fn even_blocks(length: usize, count: usize) -> Vec<Range<usize>> {
    (0..count).map(|k| k * length / count..(k + 1) * length / count).filter(|block| !block.is_empty()).collect()
}

/// Normal equations of columns and a target, over all rows and without each of [`ERROR_BLOCKS`] blocks.
pub(crate) struct Jackknife<'a> {
    columns: &'a [Vec<f64>],
    target: &'a [f64],
    /// What columns without a row, and such as a single block alone has, are given so that they stay where they are.
    slack: DMatrix<f64>,
    whole: (DMatrix<f64>, DVector<f64>),
}

impl<'a> Jackknife<'a> {
    /// Columns of the length of the target.
    pub(crate) fn new(columns: &'a [Vec<f64>], target: &'a [f64]) -> Self {
        let all = [0..target.len()];
        let gram = gram(columns, &all);
        let slack = DMatrix::from_diagonal(&gram.diagonal().map(|energy| LEAST_ENERGY_SHARE * energy.max(1.0)));
        Self { columns, target, slack, whole: (gram, moments(columns, target, &all)) }
    }

    /// Coefficients of some rows; `None` where they cannot be told apart.
    pub(crate) fn of(&self, runs: &[Range<usize>]) -> Option<DVector<f64>> {
        self.solve(&gram(self.columns, runs), &moments(self.columns, self.target, runs))
    }

    /// Errors of the coefficients of all rows, whose products add up to their covariance: what each block alone moves them by.
    pub(crate) fn errors(&self) -> Vec<DVector<f64>> {
        let (gram_of_all, moments_of_all) = &self.whole;
        let without = |block: Range<usize>| {
            let block = std::slice::from_ref(&block);
            let moments = moments_of_all - moments(self.columns, self.target, block);
            self.solve(&(gram_of_all - gram(self.columns, block)), &moments)
        };
        let without: Vec<DVector<f64>> =
            even_blocks(self.target.len(), ERROR_BLOCKS).into_iter().filter_map(without).collect();
        let count = without.len() as f64;
        let mean = without.iter().fold(DVector::zeros(self.columns.len()), |sum, one| sum + one) / count.max(1.0);
        let scale = ((count - 1.0) / count.max(1.0)).max(0.0).sqrt();
        without.iter().map(|one| (one - &mean) * scale).collect()
    }

    fn solve(&self, gram: &DMatrix<f64>, moments: &DVector<f64>) -> Option<DVector<f64>> {
        solve_symmetric(&(gram + &self.slack), moments)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::random::normal;
    use crate::numerics::regression::least_squares;
    use rand_chacha::ChaCha8Rng;
    use rand_chacha::rand_core::SeedableRng;

    /// Noise that is strong where the second column is: what a white noise of the same power would do to its coefficient is less.
    #[test]
    fn noise_that_goes_with_a_column_is_counted_where_it_is() {
        let rows = 2000;
        let mut random = ChaCha8Rng::seed_from_u64(8);
        let bump = |i: usize| f64::from(i % 20 == 7);
        let columns = [vec![1.0; rows], (0..rows).map(bump).collect::<Vec<f64>>()];
        let (mut of_draws, mut told) = (0.0, 0.0);
        for _ in 0..60 {
            let noise: Vec<f64> = (0..rows).map(|i| (0.2 + bump(i)) * normal(&mut random)).collect();
            of_draws += least_squares(&columns, &noise, &[]).coefficients[1].powi(2);
            told += Jackknife::new(&columns, &noise).errors().iter().map(|error| error[1].powi(2)).sum::<f64>();
        }
        assert!((0.7..1.5).contains(&(told / of_draws)), "{}", told / of_draws);
    }
}
