//! What a recording shows of the law that it is compared with: a law that was learned from noisy rows has errors of its own, each
//! direction of them a random effect with a normal prior (Henderson 1975; Robinson 1991) beside the base, which has none.

use crate::numerics::least_squares::{dot, gram, project_out, weighted};
use std::ops::Range;

/// Variance of an error of the law, over that of the noise, below which it hides nothing: a candidate that is nothing else loses a
/// hundredth of its evidence to it. A limit of the computing time.
const NEGLIGIBLE_VARIANCE: f64 = 0.01;

/// The errors of a law that a base leaves, whitened, as independent directions.
#[derive(Clone, Debug, Default)]
pub(crate) struct LawUncertainty {
    /// Orthonormal directions.
    directions: Vec<Vec<f64>>,
    /// Variance of the law's error along each, in variances of the noise.
    variance: Vec<f64>,
}

impl LawUncertainty {
    /// From the whitened torque of each uncertain direction at one standard deviation, beside the orthonormal directions of a base.
    pub fn beside(base: &[Vec<f64>], mut torque: Vec<Vec<f64>>, runs: &[Range<usize>]) -> Self {
        torque.iter_mut().for_each(|column| project_out(column, base, runs));
        if torque.is_empty() {
            return Self::default();
        }
        let axes = gram(&torque, runs).symmetric_eigen();
        let mut uncertainty = Self::default();
        for (axis, &variance) in axes.eigenvectors.column_iter().zip(axes.eigenvalues.iter()) {
            if variance > NEGLIGIBLE_VARIANCE {
                let mut direction = weighted(&torque, axis.as_slice());
                direction.iter_mut().for_each(|value| *value /= variance.sqrt());
                uncertainty.directions.push(direction);
                uncertainty.variance.push(variance);
            }
        }
        uncertainty
    }

    /// Columns that stand for the errors beside a base, each coefficient with a standard normal prior.
    pub fn columns(&self) -> Vec<Vec<f64>> {
        let scaled =
            |(direction, variance): (&Vec<f64>, &f64)| direction.iter().map(|value| value * variance.sqrt()).collect();
        self.directions.iter().zip(&self.variance).map(scaled).collect()
    }

    /// Whitens a column that the base has left: noise and errors of the law together have unit variance in every direction then.
    pub fn whiten(&self, column: &mut [f64], runs: &[Range<usize>]) {
        for (direction, variance) in self.directions.iter().zip(&self.variance) {
            let less = dot(column, direction, runs) * (1.0 - (1.0 + variance).sqrt().recip());
            column.iter_mut().zip(direction).for_each(|(value, d)| *value -= less * d);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::least_squares::orthonormal;

    #[test]
    fn a_column_along_an_error_of_the_law_is_whitened_and_one_across_it_stays() {
        let axis =
            |place: usize, length: f64| (0..4).map(|i| if i == place { length } else { 0.0 }).collect::<Vec<f64>>();
        let all = std::iter::once(0..4).collect::<Vec<_>>();
        let base = orthonormal(&[axis(0, 2.0)], &all);
        let uncertainty = LawUncertainty::beside(&base, vec![axis(0, 9.0), axis(1, 3.0), axis(2, 0.05)], &all);
        assert_eq!(uncertainty.columns().len(), 1, "the base takes up the first, the last is negligible");
        let mut column = vec![0.0, 2.0, 5.0, 0.0];
        uncertainty.whiten(&mut column, &all);
        assert!((column[1] - 2.0 / 10f64.sqrt()).abs() < 1e-12 && column[2] == 5.0, "{column:?}");
    }
}
