//! Cholesky factor of a dense symmetric matrix and what a penalised least squares needs from it.

use crate::numerics::products::interleaved_dot;

/// Lower Cholesky factor, row-major.
pub(in crate::kan) struct Cholesky {
    size: usize,
    factor: Vec<f64>,
}

impl Cholesky {
    /// Factors the matrix whose upper triangle is given row-major; `None` when it is not positive definite.
    pub(in crate::kan) fn new(upper: &[f64], size: usize) -> Option<Self> {
        let mut factor = vec![0.0; size * size];
        for i in 0..size {
            let (above, current) = factor.split_at_mut(i * size);
            let row = &mut current[..size];
            for j in 0..i {
                let other = &above[j * size..j * size + size];
                row[j] = (upper[j * size + i] - dot(&row[..j], &other[..j])) / other[j];
            }
            let pivot = upper[i * size + i] - dot(&row[..i], &row[..i]);
            if !(pivot > 0.0 && pivot.is_finite()) {
                return None;
            }
            row[i] = pivot.sqrt();
        }
        Some(Self { size, factor })
    }

    /// Solves for one right-hand side.
    pub(in crate::kan) fn solve(&self, right: &[f64]) -> Vec<f64> {
        let n = self.size;
        let mut solution = right.to_vec();
        for i in 0..n {
            let row = &self.factor[i * n..i * n + n];
            solution[i] = (solution[i] - dot(&row[..i], &solution[..i])) / row[i];
        }
        for i in (0..n).rev() {
            let row = &self.factor[i * n..i * n + n];
            let value = solution[i] / row[i];
            solution[i] = value;
            for (slot, l) in solution[..i].iter_mut().zip(row) {
                *slot -= l * value;
            }
        }
        solution
    }

    /// The inverse of the factor, transposed: row `c` holds column `c` of the inverse, zero before its diagonal.
    pub(in crate::kan) fn inverse_factor_transposed(&self) -> Vec<f64> {
        let n = self.size;
        let mut inverse = vec![0.0; n * n];
        for c in 0..n {
            let column = &mut inverse[c * n..c * n + n];
            column[c] = 1.0 / self.factor[c * n + c];
            for i in c + 1..n {
                let row = &self.factor[i * n..i * n + n];
                column[i] = -dot(&row[c..i], &column[c..i]) / row[i];
            }
        }
        inverse
    }
}

/// Inner product with eight partial sums, wide enough for every vector unit.
#[inline]
pub(in crate::kan) fn dot(a: &[f64], b: &[f64]) -> f64 {
    interleaved_dot::<8>(a, b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solves_and_inverts() {
        let n = 23;
        let entry = |i: usize, j: usize| 1.0 / (1.0 + i as f64 + j as f64) + if i == j { 0.5 } else { 0.0 };
        let matrix: Vec<f64> = (0..n * n).map(|k| entry(k / n, k % n)).collect();
        let expected: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
        let right: Vec<f64> = matrix.chunks(n).map(|row| dot(row, &expected)).collect();
        let cholesky = Cholesky::new(&matrix, n).unwrap();
        for (ours, theirs) in cholesky.solve(&right).iter().zip(&expected) {
            assert!((ours - theirs).abs() < 1e-12);
        }
        let inverse = cholesky.inverse_factor_transposed();
        for i in 0..n {
            for j in 0..n {
                let product: f64 = (0..n).map(|k| cholesky.factor[i * n + k] * inverse[j * n + k]).sum();
                assert!((product - if i == j { 1.0 } else { 0.0 }).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn refuses_what_is_not_positive_definite() {
        assert!(Cholesky::new(&[1.0, 2.0, 2.0, 1.0], 2).is_none());
        assert!(Cholesky::new(&[f64::NAN], 1).is_none());
    }
}
