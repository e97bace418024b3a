//! Mean residual over two channels, as cells whose colour says the sign and whose depth says the size.

use super::axis::Scale;
use super::chart::Chart;

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
    pub(super) fn svg(&self, reach: f64, labels: [&str; 2]) -> String {
        let mut chart = Chart::new((520.0, 340.0), self.x, self.y, labels);
        let edge = |(low, high): (f64, f64), k: usize, cells: usize| low + (high - low) * k as f64 / cells as f64;
        for (place, mean) in self.means.iter().enumerate() {
            let Some(mean) = mean else { continue };
            let (column, row) = (place % CELLS[0], place / CELLS[0]);
            let x = [edge(self.x, column, CELLS[0]), edge(self.x, column + 1, CELLS[0])];
            let y = [edge(self.y, row, CELLS[1]), edge(self.y, row + 1, CELLS[1])];
            let depth = (mean.abs() / reach.max(f64::MIN_POSITIVE)).min(1.0);
            chart.cell(x, y, if *mean > 0.0 { "f-hot" } else { "f-cold" }, 0.06 + 0.94 * depth);
        }
        chart.svg()
    }
}
