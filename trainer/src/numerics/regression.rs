//! Linear least squares with honest standard errors: columns scaled, collinearity seen, residuals correlated in time.

use std::ops::Range;

use crate::numerics::least_squares::residual;
use crate::numerics::products::{dot, norm};
use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// Eigenvalues of the scaled Gram matrix below this share of the largest count as zero.
const RANK_TOLERANCE: f64 = 1e-11;

/// A fitted linear model.
#[derive(Clone, Debug)]
pub struct LinearFit {
    /// One coefficient a column.
    pub coefficients: Vec<f64>,
    /// Covariance of the coefficients; residuals may be correlated within a block.
    pub covariance: DMatrix<f64>,
    /// Target minus prediction.
    pub residuals: Vec<f64>,
    /// Root mean square of the residuals.
    pub rmse: f64,
    /// Number of directions in which the columns are collinear; zero when every coefficient is determined.
    pub rank_deficiency: usize,
}

impl LinearFit {
    /// Standard error of coefficient `index`.
    #[must_use]
    pub fn standard_error(&self, index: usize) -> f64 {
        self.covariance[(index, index)].max(0.0).sqrt()
    }

    /// Value and standard error of a weighted sum of the coefficients.
    #[must_use]
    pub fn combination(&self, weights: &[f64]) -> (f64, f64) {
        let weights = DVector::from_column_slice(weights);
        let variance = (weights.transpose() * &self.covariance * &weights)[(0, 0)];
        (dot(weights.as_slice(), &self.coefficients), variance.max(0.0).sqrt())
    }
}

/// Least squares of `target` on `columns` (all of one length n >= 1), over all samples.
///
/// Standard errors are the sandwich of White (1980) with scores summed over `blocks`, so that noise coloured within a
/// block is counted. In collinear directions the solution is the one of smallest scaled norm.
#[must_use]
pub fn least_squares(columns: &[Vec<f64>], target: &[f64], blocks: &[Range<usize>]) -> LinearFit {
    let width = columns.len();
    let columns_only = Columns::of(columns);
    let coefficients = columns_only.coefficients(target);
    let Columns { scales, inverse, rank_deficiency, .. } = columns_only;

    let residuals = residual(columns, target, &coefficients);
    let rmse = norm(&residuals) / (target.len().max(1) as f64).sqrt();

    let mut meat = DMatrix::zeros(width, width);
    for block in blocks {
        let score =
            DVector::from_fn(width, |i, _| dot(&columns[i][block.clone()], &residuals[block.clone()]) / scales[i]);
        meat += &score * score.transpose();
    }
    let inflation = blocks.len() as f64 / (blocks.len().saturating_sub(1).max(1)) as f64;
    let mut covariance = &inverse * meat * &inverse * inflation;
    for i in 0..width {
        for j in 0..width {
            covariance[(i, j)] /= scales[i] * scales[j];
        }
    }
    LinearFit { coefficients, covariance, residuals, rmse, rank_deficiency }
}

/// Columns that one target after the other is fitted on.
pub(crate) struct Columns<'a> {
    columns: &'a [Vec<f64>],
    /// Norms of the columns.
    scales: Vec<f64>,
    /// Pseudo-inverse of the Gram matrix of the scaled columns.
    inverse: DMatrix<f64>,
    rank_deficiency: usize,
}

impl<'a> Columns<'a> {
    /// Columns of one length.
    pub(crate) fn of(columns: &'a [Vec<f64>]) -> Self {
        let width = columns.len();
        // A column of zeros has no direction: its coefficient and its covariances are 0.
        let scales: Vec<f64> =
            columns.iter().map(|column| Some(norm(column)).filter(|n| *n > 0.0).unwrap_or(1.0)).collect();
        let gram = DMatrix::from_fn(width, width, |i, j| dot(&columns[i], &columns[j]) / (scales[i] * scales[j]));
        let (inverse, rank_deficiency) = pseudo_inverse(gram);
        Self { columns, scales, inverse, rank_deficiency }
    }

    pub(crate) fn coefficients(&self, target: &[f64]) -> Vec<f64> {
        let moment = DVector::from_fn(self.columns.len(), |i, _| dot(&self.columns[i], target) / self.scales[i]);
        let solution = &self.inverse * moment;
        solution.iter().zip(&self.scales).map(|(x, scale)| x / scale).collect()
    }

    /// What least squares leave of a target.
    pub(crate) fn residuals(&self, target: &[f64]) -> Vec<f64> {
        residual(self.columns, target, &self.coefficients(target))
    }
}

fn pseudo_inverse(gram: DMatrix<f64>) -> (DMatrix<f64>, usize) {
    let width = gram.nrows();
    let eigen = SymmetricEigen::new(gram);
    let largest = eigen.eigenvalues.iter().fold(0.0_f64, |peak, value| peak.max(*value));
    let mut inverse = DMatrix::zeros(width, width);
    let mut lost = 0;
    for (value, vector) in eigen.eigenvalues.iter().zip(eigen.eigenvectors.column_iter()) {
        if *value > RANK_TOLERANCE * largest {
            inverse += vector * vector.transpose() / *value;
        } else {
            lost += 1;
        }
    }
    (inverse, lost)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_of_very_different_scale_come_back() {
        let n = 200;
        let a: Vec<f64> = (0..n).map(|i| 1e6 * (f64::from(i) * 0.1).sin()).collect();
        let b: Vec<f64> = (0..n).map(|i| 1e-6 * (f64::from(i) * 0.37).cos()).collect();
        let target: Vec<f64> = a.iter().zip(&b).map(|(x, y)| 2e-6 * x - 3e6 * y).collect();
        let blocks: Vec<Range<usize>> = (0..20).map(|k| 10 * k..10 * k + 10).collect();
        let fit = least_squares(&[a, b], &target, &blocks);
        assert!((fit.coefficients[0] / 2e-6 - 1.0).abs() < 1e-9 && (fit.coefficients[1] / -3e6 - 1.0).abs() < 1e-9);
        assert_eq!(fit.rank_deficiency, 0);
        assert!(fit.rmse < 1e-9);
    }

    #[test]
    fn a_column_of_zeros_changes_nothing() {
        let a: Vec<f64> = (0..50).map(|i| (f64::from(i) * 0.3).sin()).collect();
        let target: Vec<f64> = a.iter().enumerate().map(|(i, x)| 4.0 * x + (i as f64).cos()).collect();
        let fit = least_squares(&[vec![0.0; 50], a.clone()], &target, &[0..25, 25..50]);
        let alone = least_squares(&[a], &target, &[0..25, 25..50]);
        assert_eq!((fit.coefficients[0], fit.standard_error(0), fit.rank_deficiency), (0.0, 0.0, 1));
        assert!((fit.coefficients[1] / alone.coefficients[0] - 1.0).abs() < 1e-12);
        assert!((fit.standard_error(1) / alone.standard_error(0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_repeated_column_is_seen_and_shared() {
        let a: Vec<f64> = (0..50).map(|i| (f64::from(i) * 0.3).sin()).collect();
        let target: Vec<f64> = a.iter().map(|x| 4.0 * x).collect();
        let fit = least_squares(&[a.clone(), a], &target, &[0..25, 25..50]);
        assert_eq!(fit.rank_deficiency, 1);
        assert!((fit.coefficients[0] - 2.0).abs() < 1e-9 && (fit.coefficients[1] - 2.0).abs() < 1e-9);
    }
}
