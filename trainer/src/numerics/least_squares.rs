//! Small dense least squares over columns and runs of rows.

use crate::numerics::products::interleaved_dot;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use std::ops::Range;

/// Inner product of two columns over runs of rows.
pub(crate) fn dot(a: &[f64], b: &[f64], runs: &[Range<usize>]) -> f64 {
    runs.iter().map(|run| interleaved_dot::<4>(&a[run.clone()], &b[run.clone()])).sum()
}

/// Rows in runs.
pub(crate) fn rows_in(runs: &[Range<usize>]) -> usize {
    runs.iter().map(Range::len).sum()
}

/// Sum of columns weighted by coefficients.
pub(crate) fn weighted(columns: &[Vec<f64>], coefficients: &[f64]) -> Vec<f64> {
    let mut sum = vec![0.0; columns.first().map_or(0, Vec::len)];
    for (column, coefficient) in columns.iter().zip(coefficients) {
        sum.iter_mut().zip(column).for_each(|(s, c)| *s += coefficient * c);
    }
    sum
}

/// Normal matrix of columns over runs.
pub(crate) fn gram(columns: &[Vec<f64>], runs: &[Range<usize>]) -> DMatrix<f64> {
    let width = columns.len();
    let mut gram = DMatrix::zeros(width, width);
    for a in 0..width {
        for b in a..width {
            let value = dot(&columns[a], &columns[b], runs);
            gram[(a, b)] = value;
            gram[(b, a)] = value;
        }
    }
    gram
}

/// Inner products of columns with a target over runs: the right side of the normal equations.
pub(crate) fn moments(columns: &[Vec<f64>], target: &[f64], runs: &[Range<usize>]) -> DVector<f64> {
    DVector::from_iterator(columns.len(), columns.iter().map(|column| dot(column, target, runs)))
}

/// A symmetric positive matrix, factored after scaling.
pub(crate) struct Factored {
    factor: Cholesky<f64, Dyn>,
    scale: DVector<f64>,
}

impl Factored {
    /// Scaled to a unit diagonal; `None` where the matrix is singular to working precision.
    pub fn new(matrix: &DMatrix<f64>) -> Option<Self> {
        Self::scaled(matrix, unit_diagonal(matrix))
    }

    /// Scaled by another matrix' diagonal.
    pub fn scaled(matrix: &DMatrix<f64>, scale: DVector<f64>) -> Option<Self> {
        let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
            matrix[(i, j)] * scale[i] * scale[j] + if i == j { 1e-11 } else { 0.0 }
        });
        Some(Self { factor: scaled.cholesky()?, scale })
    }

    pub fn solve(&self, right: &DVector<f64>) -> Option<DVector<f64>> {
        let solution = self.factor.solve(&right.component_mul(&self.scale)).component_mul(&self.scale);
        solution.iter().all(|v| v.is_finite()).then_some(solution)
    }

    pub fn inverse(&self) -> DMatrix<f64> {
        let inverse = self.factor.inverse();
        DMatrix::from_fn(inverse.nrows(), inverse.ncols(), |i, j| inverse[(i, j)] * self.scale[i] * self.scale[j])
    }

    /// Logarithm of the determinant of the scaled matrix.
    pub fn log_determinant(&self) -> f64 {
        2.0 * self.factor.l_dirty().diagonal().iter().map(|pivot| pivot.ln()).sum::<f64>()
    }
}

/// Factors that scale a matrix to a unit diagonal; 0 where its diagonal is.
pub(crate) fn unit_diagonal(matrix: &DMatrix<f64>) -> DVector<f64> {
    let reciprocal = |d: &f64| if *d > 0.0 { d.sqrt().recip() } else { 0.0 };
    DVector::from_iterator(matrix.nrows(), matrix.diagonal().iter().map(reciprocal))
}

/// Solves a symmetric positive system with unit-diagonal scaling; `None` where it is singular to working precision.
pub(crate) fn solve_symmetric(matrix: &DMatrix<f64>, right: &DVector<f64>) -> Option<DVector<f64>> {
    Factored::new(matrix)?.solve(right)
}

/// Normal matrix of columns over runs; `ridge` is the prior precision of each over what the rows tell of it, empty for none.
pub(crate) fn ridged_gram(columns: &[Vec<f64>], ridge: &[f64], runs: &[Range<usize>]) -> DMatrix<f64> {
    let mut normal = gram(columns, runs);
    for (i, share) in ridge.iter().enumerate() {
        normal[(i, i)] *= 1.0 + share;
    }
    normal
}

/// Inverse of a symmetric positive matrix with the same scaling.
pub(crate) fn invert_symmetric(matrix: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    Factored::new(matrix).map(|factored| factored.inverse())
}

/// Coefficients of the least-squares fit of `target` by `columns` over runs; `None` where it is singular.
pub(crate) fn least_squares(columns: &[Vec<f64>], target: &[f64], runs: &[Range<usize>]) -> Option<Vec<f64>> {
    solve_symmetric(&gram(columns, runs), &moments(columns, target, runs))
        .map(|solution| solution.iter().copied().collect())
}

/// Energy of `target` that its least-squares fit by `columns` explains over runs; `None` where it is singular.
pub(crate) fn explained_energy(columns: &[Vec<f64>], target: &[f64], runs: &[Range<usize>]) -> Option<f64> {
    let asked = moments(columns, target, runs);
    let solution = solve_symmetric(&gram(columns, runs), &asked)?;
    Some(solution.dot(&asked)).filter(|energy| energy.is_finite())
}

/// Energy of `target` that one column explains over runs with a coefficient from nought to `most`; `None` of a column that is nothing.
pub(crate) fn explained_up_to(most: f64, column: &[f64], target: &[f64], runs: &[Range<usize>]) -> Option<f64> {
    let (together, own) = (dot(column, target, runs), dot(column, column, runs));
    let coefficient = (together / own).clamp(0.0, most);
    Some(coefficient * (2.0 * together - coefficient * own)).filter(|energy| energy.is_finite())
}

/// What a fit leaves: target less the weighted columns.
pub(crate) fn residual(columns: &[Vec<f64>], target: &[f64], coefficients: &[f64]) -> Vec<f64> {
    let mut residual = target.to_vec();
    for (column, coefficient) in columns.iter().zip(coefficients) {
        for (r, c) in residual.iter_mut().zip(column) {
            *r -= coefficient * c;
        }
    }
    residual
}

/// What the least-squares fit over runs leaves at every row; `None` where it is singular.
pub(crate) fn fit_residual(columns: &[Vec<f64>], target: &[f64], runs: &[Range<usize>]) -> Option<Vec<f64>> {
    least_squares(columns, target, runs).map(|coefficients| residual(columns, target, &coefficients))
}

/// Orthonormal basis of the span of columns over runs (modified Gram-Schmidt, twice); columns that depend on
/// the ones before are left out.
pub(crate) fn orthonormal(columns: &[Vec<f64>], runs: &[Range<usize>]) -> Vec<Vec<f64>> {
    let mut basis: Vec<Vec<f64>> = Vec::new();
    for column in columns {
        let before = dot(column, column, runs);
        let mut rest = column.clone();
        for _ in 0..2 {
            project_out(&mut rest, &basis, runs);
        }
        let after = dot(&rest, &rest, runs);
        if before > 0.0 && after > 1e-10 * before {
            let scale = after.sqrt().recip();
            rest.iter_mut().for_each(|v| *v *= scale);
            basis.push(rest);
        }
    }
    basis
}

/// Removes from a column its projection on an orthonormal basis over runs.
pub(crate) fn project_out(column: &mut [f64], basis: &[Vec<f64>], runs: &[Range<usize>]) {
    for direction in basis {
        let share = dot(column, direction, runs);
        for (value, d) in column.iter_mut().zip(direction) {
            *value -= share * d;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_factored_matrix_is_solved_inverted_and_measured() {
        let matrix = DMatrix::from_row_slice(2, 2, &[4.0, 2.0, 2.0, 9.0]);
        let factored = Factored::new(&matrix).expect("positive");
        let solution = factored.solve(&DVector::from_vec(vec![8.0, 20.0])).expect("finite");
        assert!((&matrix * solution - DVector::from_vec(vec![8.0, 20.0])).norm() < 1e-9);
        assert!((&matrix * factored.inverse() - DMatrix::identity(2, 2)).norm() < 1e-9);
        let determinant = 32.0 / (4.0 * 9.0);
        assert!((factored.log_determinant() - f64::ln(determinant)).abs() < 1e-9, "of the scaled matrix");
    }

    #[test]
    fn nothing_to_solve_is_solved() {
        let nothing = Factored::new(&DMatrix::zeros(0, 0)).expect("no column");
        assert_eq!(nothing.log_determinant(), 0.0);
        assert_eq!(nothing.solve(&DVector::zeros(0)).map(|solution| solution.len()), Some(0));
    }
}
