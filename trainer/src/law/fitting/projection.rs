//! Linear least squares by orthogonal projection: modified Gram-Schmidt, orthogonalised twice (Giraud, Langou & Rozloznik
//! 2005), which keeps full accuracy and shows which columns the others already hold.

/// Columns whose part outside the span of the earlier ones is smaller than this share of their norm carry nothing new.
const DEPENDENCE_THRESHOLD: f64 = 1e-9;

/// An orthonormal basis grown column by column, with the triangular factor that leads back to the columns.
#[derive(Clone, Debug, Default)]
pub struct Basis {
    vectors: Vec<Vec<f64>>,
    /// `factor[j]` holds column `j` of R up to its diagonal; `None` where the column depends on the earlier ones.
    factor: Vec<Option<Vec<f64>>>,
}

/// Inner product in a fixed order of eight interleaved sums.
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a8, b8) = (a.chunks_exact(8), b.chunks_exact(8));
    let tail: f64 = a8.remainder().iter().zip(b8.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in a8.zip(b8) {
        for i in 0..8 {
            sums[i] += x[i] * y[i];
        }
    }
    ((sums[0] + sums[4]) + (sums[2] + sums[6])) + ((sums[1] + sums[5]) + (sums[3] + sums[7])) + tail
}

fn subtract(from: &mut [f64], scale: f64, column: &[f64]) {
    for (x, y) in from.iter_mut().zip(column) {
        *x -= scale * y;
    }
}

impl Basis {
    /// The basis of `columns`, in their order.
    pub fn new<'a>(columns: impl IntoIterator<Item = &'a [f64]>) -> Self {
        let mut basis = Self::default();
        columns.into_iter().for_each(|c| {
            basis.push(c);
        });
        basis
    }

    /// Adds a column; false when it depends on those before it.
    pub fn push(&mut self, column: &[f64]) -> bool {
        let norm = dot(column, column).sqrt();
        let mut rest = column.to_vec();
        let mut r = vec![0.0; self.vectors.len()];
        for _ in 0..2 {
            for (q, r) in self.vectors.iter().zip(&mut r) {
                let c = dot(q, &rest);
                *r += c;
                subtract(&mut rest, c, q);
            }
        }
        let left = dot(&rest, &rest).sqrt();
        let independent = left.is_finite() && left > DEPENDENCE_THRESHOLD * norm;
        if independent {
            rest.iter_mut().for_each(|x| *x /= left);
            r.push(left);
            self.vectors.push(rest);
        }
        self.factor.push(independent.then_some(r));
        independent
    }

    /// Removes from `column` what the basis holds and returns the inner products.
    pub fn remove_from(&self, column: &mut [f64]) -> Vec<f64> {
        self.vectors
            .iter()
            .map(|q| {
                let c = dot(q, column);
                subtract(column, c, q);
                c
            })
            .collect()
    }

    /// Coefficients of the original columns (zero for dependent ones) from inner products with the basis.
    pub fn coefficients(&self, products: &[f64]) -> Vec<f64> {
        let kept: Vec<(usize, &Vec<f64>)> =
            self.factor.iter().enumerate().filter_map(|(j, r)| Some((j, r.as_ref()?))).collect();
        let mut rest = products.to_vec();
        let mut coefficients = vec![0.0; self.factor.len()];
        for (rank, &(j, r)) in kept.iter().enumerate().rev() {
            let c = rest[rank] / r[rank];
            coefficients[j] = c;
            for (x, r) in rest[..rank].iter_mut().zip(r.iter()) {
                *x -= c * r;
            }
        }
        coefficients
    }

    /// Standard errors of the coefficients for unit noise: row norms of the inverse triangular factor; infinite for
    /// dependent columns.
    pub fn errors(&self) -> Vec<f64> {
        let mut squares = vec![0.0; self.factor.len()];
        for rank in 0..self.rank() {
            let mut unit = vec![0.0; self.rank()];
            unit[rank] = 1.0;
            squares.iter_mut().zip(self.coefficients(&unit)).for_each(|(s, c)| *s += c * c);
        }
        let known = self.factor.iter().zip(squares);
        known.map(|(r, s): (_, f64)| if r.is_some() { s.sqrt() } else { f64::INFINITY }).collect()
    }

    /// Which of the pushed columns added something.
    pub fn independent(&self) -> Vec<bool> {
        self.factor.iter().map(Option::is_some).collect()
    }

    /// Dimension of the span.
    pub fn rank(&self) -> usize {
        self.vectors.len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_repeated_column_is_dependent_and_gets_no_weight() {
        let (a, b) = ([1.0, 2.0, 3.0, 4.0], [1.0, 0.0, 1.0, 0.0]);
        let basis = Basis::new([&a[..], &a[..], &b[..]]);
        assert_eq!(basis.independent(), [true, false, true]);
        let mut y = [3.0, 4.0, 7.0, 8.0];
        let products = basis.remove_from(&mut y);
        let c = basis.coefficients(&products);
        assert!((c[0] - 2.0).abs() < 1e-14 && c[1] == 0.0 && (c[2] - 1.0).abs() < 1e-14);
    }

    proptest! {
        #[test]
        fn recovers_coefficients_and_leaves_an_orthogonal_rest(
            rows in prop::collection::vec(prop::array::uniform4(-1.0..1.0f64), 12..40),
            truth in prop::array::uniform3(-5.0..5.0f64),
        ) {
            let column = |i: usize| rows.iter().map(|r| r[i]).collect::<Vec<_>>();
            let columns = [column(0), column(1), column(2)];
            let basis = Basis::new(columns.iter().map(Vec::as_slice));
            prop_assume!(basis.rank() == 3);
            let mut y: Vec<f64> =
                rows.iter().map(|r| (0..3).map(|i| truth[i] * r[i]).sum::<f64>()).collect();
            let products = basis.remove_from(&mut y);
            for (c, t) in basis.coefficients(&products).iter().zip(truth) {
                prop_assert!((c - t).abs() < 1e-8);
            }
            let mut other = column(3);
            basis.remove_from(&mut other);
            for c in &columns {
                prop_assert!(dot(c, &other).abs() < 1e-10);
            }
        }
    }
}
