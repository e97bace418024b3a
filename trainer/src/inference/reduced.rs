//! Products of candidates and target with the base and the random effects integrated out.

use crate::inference::products::products;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// Share of a column's energy beyond the base, below which it lies within the base but for rounding: products of doubles keep half of
/// their digits.
const WITHIN_BASE_SHARE: f64 = 1e-8;
/// Precision of a random effect over what all rows tell of it, at least: what keeps two that are one for the rows apart, far above the
/// rounding of doubles.
const LEAST_PRECISION: f64 = 1e-11;

/// What is left of the products of candidates `X` and target `y` once base and random effects took their part; whitened, so that the
/// noise has unit variance.
#[derive(Clone, Debug)]
pub(crate) struct Reduced {
    /// `X'PX`.
    pub gram: DMatrix<f64>,
    /// `X'Py`.
    pub moments: DVector<f64>,
    /// `y'Py`.
    pub energy: f64,
}

impl Reduced {
    /// From the products of `[B, X, y]`, of which the first `base` columns are flat and the last is the target.
    pub fn without_base(products: &DMatrix<f64>, base: usize) -> Self {
        let left = eliminated(products, base);
        let width = left.nrows() - 1;
        Self {
            gram: left.view((0, 0), (width, width)).clone_owned(),
            moments: left.view((0, width), (width, 1)).column(0).clone_owned(),
            energy: left[(width, width)],
        }
    }

    /// The same with the sum of its columns by some weights in the base: flat, as large as the rows ask for.
    pub fn without_sum(&self, weights: &DVector<f64>) -> Self {
        let products = &self.gram * weights;
        let energy = weights.dot(&products);
        if energy <= 0.0 {
            return self.clone();
        }
        let moment = weights.dot(&self.moments) / energy;
        Self {
            gram: &self.gram - &products * products.transpose() / energy,
            moments: &self.moments - &products * moment,
            energy: self.energy - energy * moment * moment,
        }
    }

    /// Sum of the products over two sets of rows.
    pub fn plus(&self, other: &Self) -> Self {
        Self {
            gram: &self.gram + &other.gram,
            moments: &self.moments + &other.moments,
            energy: self.energy + other.energy,
        }
    }
}

/// Random effects that are always in the model: columns at some places, over more rows than the candidates act on.
pub(crate) struct RandomEffects {
    places: Vec<usize>,
    factor: Cholesky<f64, Dyn>,
    /// Factors that scale their matrix to a unit diagonal.
    scale: Vec<f64>,
    /// `L^-1` times their products with the candidates on their own rows, then on all rows.
    across: DMatrix<f64>,
    /// Their products with the target over all rows.
    moments: DVector<f64>,
}

impl RandomEffects {
    /// Columns at `places` with a precision each, by the products `all` over all rows on which they act and `own` over those on which the
    /// candidates do. `None` where they are singular to working precision.
    pub fn new(all: &Reduced, own: &Reduced, places: Vec<usize>, precision: &[f64]) -> Option<Self> {
        let diagonal = |i: usize| all.gram[(places[i], places[i])] + precision[i];
        let scale: Vec<f64> =
            (0..places.len()).map(|i| if diagonal(i) > 0.0 { diagonal(i).sqrt().recip() } else { 0.0 }).collect();
        let matrix = DMatrix::from_fn(places.len(), places.len(), |i, j| {
            if i == j { 1.0 + LEAST_PRECISION } else { scale[i] * scale[j] * all.gram[(places[i], places[j])] }
        });
        let factor = matrix.cholesky()?;
        let width = own.gram.nrows();
        let mut across = DMatrix::from_fn(places.len(), 2 * width, |i, j| {
            let of = if j < width { own } else { all };
            scale[i] * of.gram[(places[i], j % width)]
        });
        factor.l_dirty().solve_lower_triangular_mut(&mut across);
        let moments = DVector::from_fn(places.len(), |i, _| all.moments[places[i]]);
        Some(Self { factor, scale, across, moments, places })
    }

    /// The products of candidates on their `own` rows and on `all` rows with the random effects integrated out: columns are the own
    /// ones, then, in the same order, those that act on all rows.
    pub fn integrated_out(&self, all: &Reduced, own: &Reduced) -> Reduced {
        let width = own.gram.nrows();
        let weighed = self.weighed(&self.moments);
        let columns: Vec<Vec<f64>> = self.across.column_iter().map(|column| column.iter().copied().collect()).collect();
        let taken = products(&columns);
        let before = |i: usize, j: usize| {
            let of = if i < width || j < width { own } else { all };
            of.gram[(i % width, j % width)]
        };
        let moment = |i: usize| if i < width { own.moments[i] } else { all.moments[i - width] };
        let taken_moments = self.across.tr_mul(&weighed);
        let mut left = Reduced {
            gram: DMatrix::from_fn(2 * width, 2 * width, |i, j| before(i, j) - taken[(i, j)]),
            moments: DVector::from_fn(2 * width, |i, _| moment(i) - taken_moments[i]),
            energy: all.energy - weighed.norm_squared(),
        };
        // What is left of a column but rounding is none.
        for i in 0..2 * width {
            if left.gram[(i, i)] <= WITHIN_BASE_SHARE * before(i, i) {
                left.gram.row_mut(i).fill(0.0);
                left.gram.column_mut(i).fill(0.0);
                left.moments[i] = 0.0;
            }
        }
        left
    }

    /// Places of their columns.
    pub fn places(&self) -> &[usize] {
        &self.places
    }

    /// Means of the random effects beside candidates of given coefficients (place among own and shared columns, coefficient).
    pub fn means(&self, all: &Reduced, own: &Reduced, candidates: &[(usize, f64)]) -> Vec<f64> {
        let width = own.gram.nrows();
        let product = |i: usize, j: usize| {
            let of = if j < width { own } else { all };
            of.gram[(self.places[i], j % width)]
        };
        let moments = DVector::from_fn(self.places.len(), |i, _| {
            let taken: f64 = candidates.iter().map(|(place, value)| product(i, *place) * value).sum();
            self.moments[i] - taken
        });
        let mut mean = self.weighed(&moments);
        self.factor.l_dirty().tr_solve_lower_triangular_mut(&mut mean);
        mean.iter().zip(&self.scale).map(|(mean, scale)| mean * scale).collect()
    }

    /// Takes from products of other targets, which are zero but on the candidates' own rows (one a row of `moments`), what the random
    /// effects take; columns as of [`Self::integrated_out`].
    pub fn beside(&self, moments: &DMatrix<f64>) -> DMatrix<f64> {
        let width = moments.ncols();
        let mut of_random =
            DMatrix::from_fn(self.places.len(), moments.nrows(), |i, k| self.scale[i] * moments[(k, self.places[i])]);
        self.factor.l_dirty().solve_lower_triangular_mut(&mut of_random);
        let twice = DMatrix::from_fn(moments.nrows(), 2 * width, |k, j| moments[(k, j % width)]);
        twice - of_random.tr_mul(&self.across)
    }

    fn weighed(&self, moments: &DVector<f64>) -> DVector<f64> {
        let mut weighed = DVector::from_fn(moments.len(), |i, _| self.scale[i] * moments[i]);
        self.factor.l_dirty().solve_lower_triangular_mut(&mut weighed);
        weighed
    }
}

/// Schur complement of the first `count` columns of a symmetric matrix. What of a later column lies within the first but for rounding is set to zero.
fn eliminated(matrix: &DMatrix<f64>, count: usize) -> DMatrix<f64> {
    let size = matrix.nrows();
    let mut work = matrix.clone();
    let original: Vec<f64> = (0..size).map(|i| work[(i, i)]).collect();
    for pivot in 0..count {
        let diagonal = work[(pivot, pivot)];
        if diagonal <= WITHIN_BASE_SHARE * original[pivot] || diagonal <= 0.0 {
            continue;
        }
        let row: Vec<f64> = (pivot..size).map(|j| work[(j, pivot)]).collect();
        for j in pivot + 1..size {
            let share = row[j - pivot] / diagonal;
            if share != 0.0 {
                let mut column = work.view_mut((j, j), (size - j, 1));
                for (value, pivot_value) in column.iter_mut().zip(&row[j - pivot..]) {
                    *value -= share * pivot_value;
                }
            }
        }
    }
    let rest = size - count;
    let is_within: Vec<bool> =
        (count..size).map(|i| work[(i, i)] <= WITHIN_BASE_SHARE * original[i] && i + 1 < size).collect();
    DMatrix::from_fn(rest, rest, |i, j| {
        let (low, high) = (i.min(j), i.max(j));
        if is_within[low] || is_within[high] { 0.0 } else { work[(count + high, count + low)] }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column(seed: usize, rows: usize) -> Vec<f64> {
        (0..rows).map(|i| ((i * (2 * seed + 3) + seed * seed) % 17) as f64 - 8.0).collect()
    }

    #[test]
    fn what_lies_within_the_base_is_gone_and_the_rest_is_projected() {
        let rows = 200;
        let (base, candidate, target) = (column(1, rows), column(2, rows), column(5, rows));
        let twice: Vec<f64> = base.iter().map(|v| 2.0 * v).collect();
        let reduced = Reduced::without_base(
            &products(&[base.clone(), twice.clone(), candidate.clone(), twice, target.clone()]),
            2,
        );
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
        let left = |c: &[f64]| -> Vec<f64> {
            let share = dot(c, &base) / dot(&base, &base);
            c.iter().zip(&base).map(|(c, b)| c - share * b).collect()
        };
        assert!((reduced.gram[(0, 0)] - dot(&left(&candidate), &candidate)).abs() < 1e-6);
        assert!((reduced.moments[0] - dot(&left(&candidate), &target)).abs() < 1e-6);
        assert!((reduced.energy - dot(&left(&target), &target)).abs() < 1e-6);
        assert_eq!([reduced.gram[(1, 1)], reduced.gram[(0, 1)], reduced.moments[1]], [0.0; 3]);
    }

    #[test]
    fn a_sum_of_columns_that_is_taken_off_is_one_of_the_base() {
        let columns: Vec<Vec<f64>> = [3, 4, 7].map(|seed| column(seed, 300)).to_vec();
        let sum: Vec<f64> = columns[0].iter().zip(&columns[1]).map(|(a, b)| 0.5 * a - 2.0 * b).collect();
        let taken = Reduced::without_base(&products(&columns), 0).without_sum(&DVector::from_vec(vec![0.5, -2.0]));
        let based = Reduced::without_base(&products(&[&[sum][..], &columns].concat()), 1);
        assert!((&taken.gram - &based.gram).norm() < 1e-6 && (&taken.moments - &based.moments).norm() < 1e-6);
        assert!((taken.energy - based.energy).abs() < 1e-6);
    }

    #[test]
    fn a_random_effect_of_great_precision_takes_nothing_and_a_flat_one_is_of_the_base() {
        let rows = 300;
        let columns: Vec<Vec<f64>> = [3, 4, 7].map(|seed| column(seed, rows)).to_vec();
        let all = Reduced::without_base(&products(&columns), 0);
        let with =
            |precision: f64| RandomEffects::new(&all, &all, vec![0], &[precision]).unwrap().integrated_out(&all, &all);
        assert!((with(1e15).gram[(1, 1)] - all.gram[(1, 1)]).abs() < 1e-4);
        assert_eq!(with(1e15).gram.nrows(), 4, "own columns and those on all rows");
        let flat = with(0.0);
        let based = Reduced::without_base(&products(&columns), 1);
        assert!((flat.gram[(1, 1)] - based.gram[(0, 0)]).abs() < 1e-6);
        assert!((flat.moments[1] - based.moments[0]).abs() < 1e-6);
    }
}
