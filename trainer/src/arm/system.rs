//! Weighted least squares over all joints: parameters that they share, and columns of their own, block of time by block of time.

use std::ops::Range;

use nalgebra::{DMatrix, DVector};

use crate::numerics::least_squares::{gram, invert_symmetric, moments, solve_symmetric};
use crate::numerics::products::dot;

/// Energy that every coefficient is given beside that of its rows, as a share: what nothing determines stays where it is expected.
const SLACK: f64 = 1e-9;

/// What one joint contributes: rows with the shared columns that it feels (`None` is a column of zeros) and columns of its own.
pub(super) struct JointRows<'a> {
    /// Samples that count, ascending.
    pub(super) rows: &'a [usize],
    /// One value a sample.
    pub(super) shared: &'a [Option<Vec<f64>>],
    /// One value for each of `rows`.
    pub(super) own: Vec<Vec<f64>>,
    /// What is to be explained, one value a sample.
    pub(super) target: &'a [f64],
    /// What a prediction is scored on, one value a sample.
    pub(super) scored: &'a [f64],
}

/// Products of the columns of one joint over one block, shared columns first.
struct Products {
    rows: usize,
    gram: DMatrix<f64>,
    moments: DVector<f64>,
    energy: f64,
    /// Moments and energy of what is scored.
    scored: (DVector<f64>, f64),
}

/// What is expected of the shared parameters before a row is seen, with its precision (0 for none).
pub(super) struct Expected {
    pub(super) values: Vec<f64>,
    pub(super) precision: Vec<f64>,
}

/// The normal equations.
pub(super) struct System {
    shared: usize,
    /// Where the own coefficients of each joint begin.
    begins: Vec<usize>,
    width: usize,
    /// Joint by joint, block by block.
    products: Vec<Vec<Products>>,
}

impl System {
    /// Blocks are ranges of samples.
    pub(super) fn new(joints: &[JointRows<'_>], blocks: &[Range<usize>]) -> Self {
        let shared = joints.first().map_or(0, |joint| joint.shared.len());
        let mut width = shared;
        let begins = joints.iter().map(|joint| (width, width += joint.own.len()).0).collect();
        let products = joints.iter().map(|joint| blocks.iter().map(|block| Products::of(joint, block)).collect());
        Self { shared, begins, products: products.collect(), width }
    }

    /// Takes what is to be explained of a joint so many times.
    pub(super) fn scale(&mut self, joint: usize, factor: f64) {
        for block in &mut self.products[joint] {
            block.moments *= factor;
            block.energy *= factor * factor;
            block.scored.0 *= factor;
            block.scored.1 *= factor * factor;
        }
    }

    /// How many times the torque that shared parameters make of a joint is in what is to be explained of it, its own columns identified
    /// along; `None` where they make none.
    pub(super) fn share_of(&self, joint: usize, shared: &[f64]) -> Option<f64> {
        let blocks = &self.products[joint];
        let width = blocks.first()?.moments.len();
        let gram = blocks.iter().fold(DMatrix::zeros(width, width), |sum, block| sum + &block.gram);
        let moments = blocks.iter().fold(DVector::zeros(width), |sum, block| sum + &block.moments);
        let own = width - self.shared;
        // The shared columns as one, then the own.
        let mut together = DMatrix::zeros(width, 1 + own);
        shared.iter().enumerate().for_each(|(index, value)| together[(index, 0)] = *value);
        (0..own).for_each(|index| together[(self.shared + index, 1 + index)] = 1.0);
        let matrix = together.transpose() * gram * &together;
        (matrix[(0, 0)] > 0.0)
            .then(|| solve_symmetric(&matrix, &(together.transpose() * moments)))?
            .map(|found| found[0])
    }

    /// Number of joints.
    pub(super) fn joints(&self) -> usize {
        self.products.len()
    }

    /// Number of blocks.
    pub(super) fn blocks(&self) -> usize {
        self.products.first().map_or(0, Vec::len)
    }

    /// Normal matrix and moments of the blocks that count, each joint with its weight.
    fn normal(&self, weights: &[f64], counts: &dyn Fn(usize) -> bool) -> (DMatrix<f64>, DVector<f64>) {
        let mut matrix = DMatrix::zeros(self.width, self.width);
        let mut right = DVector::zeros(self.width);
        for ((blocks, begin), weight) in self.products.iter().zip(&self.begins).zip(weights) {
            let place = |index: usize| if index < self.shared { index } else { begin + index - self.shared };
            for (_, block) in blocks.iter().enumerate().filter(|(index, _)| counts(*index)) {
                for i in 0..block.gram.nrows() {
                    right[place(i)] += weight * block.moments[i];
                    for j in 0..block.gram.ncols() {
                        matrix[(place(i), place(j))] += weight * block.gram[(i, j)];
                    }
                }
            }
        }
        (matrix, right)
    }

    /// Coefficients from the blocks that count; `None` where they cannot be told apart.
    pub(super) fn solve(
        &self,
        weights: &[f64],
        expected: &Expected,
        counts: &dyn Fn(usize) -> bool,
    ) -> Option<DVector<f64>> {
        let (matrix, right) = self.normal(weights, counts);
        let slack = matrix.diagonal() * SLACK;
        self.with_expected(matrix, right, expected, &slack)
    }

    fn with_expected(
        &self,
        mut matrix: DMatrix<f64>,
        mut right: DVector<f64>,
        expected: &Expected,
        slack: &DVector<f64>,
    ) -> Option<DVector<f64>> {
        for index in 0..self.width {
            let (value, precision) = if index < self.shared {
                (expected.values[index], expected.precision[index] + slack[index])
            } else {
                (0.0, slack[index])
            };
            matrix[(index, index)] += precision;
            right[index] += precision * value;
        }
        solve_symmetric(&matrix, &right)
    }

    /// What the blocks leave out of the coefficients in turn, scaled so that their products add up to a covariance (Quenouille 1956; blocks
    /// allow for noise that is correlated within them).
    pub(super) fn errors(&self, weights: &[f64], expected: &Expected) -> Vec<DVector<f64>> {
        let (whole, right) = self.normal(weights, &|_| true);
        let slack = whole.diagonal() * SLACK;
        let without = |left_out: usize| {
            let (matrix, moments) = self.normal(weights, &|block| block == left_out);
            self.with_expected(&whole - matrix, &right - moments, expected, &slack)
        };
        let without: Vec<DVector<f64>> = (0..self.blocks()).filter_map(without).collect();
        let count = without.len().max(1) as f64;
        let mean = without.iter().fold(DVector::zeros(self.width), |sum, one| sum + one) / count;
        let scale = ((count - 1.0) / count).max(0.0).sqrt();
        without.iter().map(|one| (one - &mean) * scale).collect()
    }

    /// What the rows tell of each shared parameter beside all other coefficients: the energy of its column that they leave, weighted.
    pub(super) fn told(&self, weights: &[f64]) -> Vec<f64> {
        let (matrix, _) = self.normal(weights, &|_| true);
        let inverse = invert_symmetric(&matrix);
        let told = |index: usize| {
            let variance = inverse.as_ref().map_or(0.0, |inverse| inverse[(index, index)]);
            if matrix[(index, index)] > 0.0 && variance > 0.0 { variance.recip() } else { 0.0 }
        };
        (0..self.shared).map(told).collect()
    }

    /// Mean square of what coefficients leave of the target of each joint, or of what is scored, over the blocks that count.
    pub(super) fn left(&self, solution: &DVector<f64>, counts: &dyn Fn(usize) -> bool, scored: bool) -> Vec<f64> {
        let of = |(joint, blocks): (usize, &Vec<Products>)| {
            let own = self.of_joint(solution, joint);
            let (mut sum, mut rows) = (0.0, 0.0);
            for (_, block) in blocks.iter().enumerate().filter(|(index, _)| counts(*index)) {
                let (moments, energy) =
                    if scored { (&block.scored.0, block.scored.1) } else { (&block.moments, block.energy) };
                sum += energy - 2.0 * own.dot(moments) + own.dot(&(&block.gram * &own));
                rows += block.rows as f64;
            }
            if rows > 0.0 { (sum / rows).max(0.0) } else { 0.0 }
        };
        self.products.iter().enumerate().map(of).collect()
    }

    /// The coefficients of one joint, shared ones first.
    fn of_joint(&self, solution: &DVector<f64>, joint: usize) -> DVector<f64> {
        let own = self.products[joint].first().map_or(0, |block| block.moments.len() - self.shared);
        let places = (0..self.shared).chain(self.begins[joint]..self.begins[joint] + own);
        DVector::from_iterator(self.shared + own, places.map(|place| solution[place]))
    }

    /// Place of the first of the own coefficients of a joint.
    pub(super) fn first_of(&self, joint: usize) -> usize {
        self.begins[joint]
    }
}

impl Products {
    fn of(joint: &JointRows<'_>, block: &Range<usize>) -> Self {
        let at =
            joint.rows.partition_point(|row| *row < block.start)..joint.rows.partition_point(|row| *row < block.end);
        let rows = &joint.rows[at.clone()];
        let pick = |column: &[f64]| rows.iter().map(|row| column[*row]).collect::<Vec<f64>>();
        let shared = joint.shared.iter().map(|column| column.as_deref().map_or_else(|| vec![0.0; rows.len()], pick));
        let columns: Vec<Vec<f64>> = shared.chain(joint.own.iter().map(|column| column[at.clone()].to_vec())).collect();
        let all = [0..rows.len()];
        let [target, scored] = [joint.target, joint.scored].map(pick);
        Self {
            rows: rows.len(),
            gram: gram(&columns, &all),
            moments: moments(&columns, &target, &all),
            energy: dot(&target, &target),
            scored: (moments(&columns, &scored, &all), dot(&scored, &scored)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::jackknife::even_blocks;

    #[test]
    fn joints_share_what_they_share_and_keep_what_is_their_own() {
        let samples = 200;
        let wave = |rate: f64| (0..samples).map(|i| (rate * f64::from(i)).sin()).collect::<Vec<f64>>();
        let [a, b, sign] = [wave(0.11), wave(0.23), wave(0.07).iter().map(|x| x.signum()).collect::<Vec<f64>>()];
        let rows: Vec<usize> = (0..samples as usize).collect();
        let first: Vec<f64> = (0..rows.len()).map(|i| 2.0 * a[i] + 0.5 * sign[i]).collect();
        let second: Vec<f64> = (0..rows.len()).map(|i| 2.0 * b[i] - 3.0 * a[i] - 0.25 * sign[i]).collect();
        let [shared_first, shared_second] = [[Some(a.clone()), None], [Some(b.clone()), Some(a)]];
        let of = |shared, target| JointRows { rows: &rows, shared, own: vec![sign.clone()], target, scored: target };
        let system = System::new(&[of(&shared_first, &first), of(&shared_second, &second)], &even_blocks(200, 10));
        let nothing = Expected { values: vec![0.0; 2], precision: vec![0.0; 2] };
        let found = system.solve(&[1.0, 4.0], &nothing, &|_| true).unwrap();
        for (found, wanted) in found.iter().zip([2.0, -3.0, 0.5, -0.25]) {
            assert!((found - wanted).abs() < 1e-6, "{found} {wanted}");
        }
        assert!(system.left(&found, &|_| true, false).iter().all(|left| *left < 1e-10));
        assert!(system.errors(&[1.0, 4.0], &nothing).iter().all(|error| error.norm() < 1e-6));
        assert_eq!((system.first_of(0), system.first_of(1)), (2, 3));
        assert!((system.share_of(1, &[1.0, -1.5]).unwrap() - 2.0).abs() < 1e-6);
        let told = system.told(&[1.0, 4.0]);
        assert!(told[0] > 100.0 && told[1] > 100.0, "{told:?}");
    }
}
