//! Mean residual over two channels, as cells whose colour says the sign and whose depth says the size.

use crate::report::page::{Cells, Plot};
use crate::report::picture::Scale;

/// Cells along each axis.
const CELLS: [usize; 2] = [28, 18];
/// Rows below which a cell says nothing.
const LEAST_ROWS: f64 = 2.0;

/// Mean of `values` in cells over `x` and `y`.
pub(super) struct HeatMap {
    x: (f64, f64),
    y: (f64, f64),
    means: Vec<Option<f64>>,
}

impl HeatMap {
    pub(super) fn of(x: &[f64], y: &[f64], values: &[f64]) -> Self {
        let (range_x, range_y) = (Scale::over(x.iter().copied()), Scale::over(y.iter().copied()));
        let mut sums = vec![(0.0, 0.0); CELLS[0] * CELLS[1]];
        let cell = |value: f64, (low, high): (f64, f64), cells: usize| {
            (((value - low) / (high - low) * cells as f64) as usize).min(cells - 1)
        };
        for ((x, y), value) in x.iter().zip(y).zip(values) {
            let place = cell(*y, range_y, CELLS[1]) * CELLS[0] + cell(*x, range_x, CELLS[0]);
            sums[place].0 += value;
            sums[place].1 += 1.0;
        }
        let means = sums.iter().map(|(sum, count)| (*count >= LEAST_ROWS).then(|| sum / count)).collect();
        Self { x: range_x, y: range_y, means }
    }

    /// Largest magnitude of a cell, leaving out the most extreme two per cent.
    pub(super) fn reach(&self) -> f64 {
        let mut sizes: Vec<f64> = self.means.iter().flatten().map(|mean| mean.abs()).collect();
        sizes.sort_unstable_by(f64::total_cmp);
        sizes.get((sizes.len() as f64 * 0.98) as usize).or(sizes.last()).copied().unwrap_or(0.0)
    }

    /// The picture; full colour at `reach`, so that two maps can be compared.
    pub(super) fn plot(&self, name: &str, reach: f64, labels: [&str; 2], unit: &'static str) -> Plot {
        let values = self.means.iter().map(|mean| mean.unwrap_or(f64::NAN)).collect();
        let ends = |(low, high): (f64, f64)| [low, high];
        let reach = reach.max(f64::MIN_POSITIVE);
        Plot::of_cells(name, labels, Cells { x: ends(self.x), y: ends(self.y), size: CELLS, values, reach, unit })
    }
}
