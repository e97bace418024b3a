//! Edges of a network as cubics in integers: their rows, the range of the sums in which they end, and the steps of these.

use frikan_shared::table::Cell;

use super::cells::{Cubic, bound_cell, fit_cell};
use super::formula::Curve;

/// Positions of a sum, as a power of two.
const SUM: f64 = 2_147_483_648.0;

/// Share of a sum's positions that its range leaves unused, for roundings.
const SPARE: f64 = 1.0e-3;

/// Steps by which whole coefficients and the flooring of the evaluation move a value, at most.
const ROUNDING_STEPS: f64 = 4.0;

/// An edge: a cubic for each row, in the unit of the sum in which it ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Edge {
    /// Cubics in the local coordinate of their rows.
    pub cubics: Vec<Cubic>,
    /// Certified error, apart from the rounding to steps.
    pub error: f64,
}

impl Edge {
    /// The edge `curve` over rows, whose local coordinate is found to within `coordinate_error`; without a curve, nothing.
    #[must_use]
    pub fn new(curve: Option<&dyn Curve>, rows: &[(f64, f64)], coordinate_error: f64) -> Self {
        let Some(curve) = curve else { return Self { cubics: vec![[0.0; 4]; rows.len()], error: 0.0 } };
        let cubics: Vec<Cubic> = rows.iter().map(|&(near, far)| fit_cell(curve, near, far)).collect();
        let error = rows.iter().zip(&cubics).fold(0.0f64, |worst, (&(near, far), cubic)| {
            let (approximation, moved) = bound_cell(curve, near, far, cubic, coordinate_error);
            worst.max(approximation + moved)
        });
        Self { cubics, error }
    }

    /// Least and largest Bernstein coefficient of all rows.
    fn range(&self) -> (f64, f64) {
        let bernstein = |&[c0, c1, c2, c3]: &Cubic| [c0, c0 + c1 / 3.0, c0 + (2.0 * c1 + c2) / 3.0, c0 + c1 + c2 + c3];
        self.cubics
            .iter()
            .flat_map(bernstein)
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), b| (low.min(b), high.max(b)))
    }

    /// The largest partial sum of the evaluation but the last.
    fn inner(&self) -> f64 {
        let partial = |&[_, c1, c2, c3]: &Cubic| {
            let second = 4.0 * c2.abs() + 4.0 * c3.abs();
            second.max(2.0 * c1.abs() + 0.5 * second)
        };
        self.cubics.iter().map(partial).fold(0.0, f64::max)
    }
}

/// The steps of a sum: a value is `low` and `step` for each position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// The value at position 0.
    pub low: f64,
    /// Value for each position.
    pub step: f64,
}

impl Scale {
    /// The values at position 0 and at `2^31`.
    #[must_use]
    pub fn range(self) -> [f64; 2] {
        [self.low, self.low + self.step * SUM]
    }

    /// The steps of an additive node, whose positions are not negative.
    #[must_use]
    pub fn positive(edges: &[&Edge]) -> Self {
        let (low, high) = edges.iter().map(|edge| edge.range()).fold((0.0, 0.0), |sum, r| (sum.0 + r.0, sum.1 + r.1));
        let width = floor(edges, high - low);
        Self { low: low - 0.5 * SPARE * width, step: width * (1.0 + SPARE) / SUM }
    }

    /// The steps of a sum of either sign.
    #[must_use]
    pub fn signed(edges: &[&Edge]) -> Self {
        let largest = edges.iter().map(|edge| edge.range()).map(|(low, high)| low.abs().max(high.abs())).sum();
        Self { low: 0.0, step: f64::from((floor(edges, largest) * (1.0 + SPARE) / SUM) as f32) }
    }

    /// The steps of the product of two sums, by what the runtime makes of their positions: `2^30 + s t / 2^32`.
    #[must_use]
    pub fn of_product(self, other: Self) -> Self {
        let step = self.step * other.step * 2.0 * SUM;
        Self { low: -0.5 * step * SUM, step }
    }

    /// Error of an edge in whole coefficients, in the unit of the sum.
    #[must_use]
    pub fn rounding(self) -> f64 {
        ROUNDING_STEPS * self.step
    }
}

/// `width`, or what the partial sums of the edges need where that is more.
fn floor(edges: &[&Edge], width: f64) -> f64 {
    let constant = edges.iter().map(|edge| edge.range().1.abs()).fold(1.0e-9, f64::max);
    edges.iter().map(|edge| edge.inner()).fold(width.max(1.0e-6 * constant), f64::max)
}

/// The cells of sources, each of which has an edge to every sum: source by source, row by row, sum by sum.
#[must_use]
pub fn cells(sources: &[Vec<Edge>], scales: &[Scale], positive: impl Fn(usize) -> bool) -> Vec<Vec<Cell>> {
    let spare: Vec<f64> = scales
        .iter()
        .enumerate()
        .map(|(target, scale)| {
            // What the sum's position 0 lies below the least value of its edges together.
            let least: f64 = sources.iter().map(|edges| edges[target].range().0).sum();
            if positive(target) { least - scale.low } else { 0.0 }
        })
        .collect();
    sources
        .iter()
        .enumerate()
        .map(|(source, edges)| {
            let rows = edges.first().map_or(0, |edge| edge.cubics.len());
            let mut cells = Vec::with_capacity(rows * edges.len());
            for row in 0..rows {
                for (target, edge) in edges.iter().enumerate() {
                    let [c0, c1, c2, c3] = edge.cubics[row];
                    let own = if positive(target) { edge.range().0 } else { 0.0 };
                    let first = if source == 0 { spare[target] } else { 0.0 };
                    let whole = [c0 - own + first, 2.0 * c1, 4.0 * c2, 8.0 * c3];
                    cells.push(Cell::from_integers(whole.map(|c| (c / scales[target].step).round() as i32)));
                }
            }
            cells
        })
        .collect()
}
