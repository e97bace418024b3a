//! Where knots lie: monotone maps from an input to a share of its knots.

use super::error::KanError;
use super::spline::{Grid, SplineBasis};

/// Monotone map from a normalised input in `[-1, 1]` to a share of the knots in `[0, 1]`, linear between points.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::kan) struct Placement {
    /// Normalised input, ascending from -1 to 1.
    pub(in crate::kan) position: Vec<f64>,
    /// Share of the knots below each position, ascending from 0 to 1.
    pub(in crate::kan) share: Vec<f64>,
}

impl Placement {
    pub(in crate::kan) fn uniform() -> Self {
        Self { position: vec![-1.0, 1.0], share: vec![0.0, 1.0] }
    }

    /// Knots that crowd about zero: equal steps of `asinh`, the more so the larger `warp`.
    pub(in crate::kan) fn crowded(warp: f64) -> Self {
        let share: Vec<f64> = (0..=64).map(|i| f64::from(i) / 64.0).collect();
        let end = libm::sinh(warp);
        let mut position: Vec<f64> = share.iter().map(|s| libm::sinh(warp * (2.0 * s - 1.0)) / end).collect();
        (position[0], position[64]) = (-1.0, 1.0);
        Self { position, share }
    }

    /// Share of the knots below `x`.
    pub(in crate::kan) fn share_below(&self, x: f64) -> f64 {
        interpolate(&self.position, &self.share, x)
    }

    /// The mean of a placement and its mirror image.
    pub(in crate::kan) fn symmetric(&self) -> Self {
        let mirrored = Self {
            position: self.position.iter().rev().map(|x| -x).collect(),
            share: self.share.iter().rev().map(|s| 1.0 - s).collect(),
        };
        self.mean(&mirrored)
    }

    fn mean(&self, other: &Self) -> Self {
        let mut position: Vec<f64> = self.position.iter().chain(&other.position).copied().collect();
        position.sort_by(f64::total_cmp);
        position.dedup_by(|a, b| (*a - *b).abs() < 1e-12);
        let share = |x: f64| 0.5 * (self.share_below(x) + other.share_below(x));
        Self { share: position.iter().map(|&x| share(x)).collect(), position }
    }

    /// Boundaries of `cells` cells; inner ones are drawn away from the middle, at most half a cell for a `stretch` of 1
    /// (towards it for -1).
    pub(in crate::kan) fn breaks(&self, cells: usize, stretch: f64) -> Vec<f64> {
        let mut breaks: Vec<f64> =
            stretched(cells, stretch).map(|share| interpolate(&self.share, &self.position, share)).collect();
        // Cells never vanish, however steep the law.
        let least = MINIMUM_CELL / cells as f64;
        for i in 1..cells {
            breaks[i] = breaks[i].max(breaks[i - 1] + least).min(1.0 - least * (cells - i) as f64);
        }
        breaks
    }

    /// The basis over such cells.
    pub(in crate::kan) fn basis(&self, cells: usize, order: usize, stretch: f64) -> Result<SplineBasis, KanError> {
        SplineBasis::new(Grid { order, breaks: self.breaks(cells, stretch) })
    }
}

/// Boundaries of cells over `[0, 1]`, symmetric about its middle: equal cells, inner boundaries moved outwards by up
/// to half a cell (`stretch` 1), or inwards (-1). The ends stay.
pub(in crate::kan) fn stretched(cells: usize, stretch: f64) -> impl Iterator<Item = f64> {
    (0..=cells).map(move |i| match i {
        0 => 0.0,
        i if i == cells => 1.0,
        i => 0.5 + (i as f64 / cells as f64 - 0.5) * (1.0 + stretch / cells as f64),
    })
}

/// Smallest width of a cell relative to that of a uniform one.
const MINIMUM_CELL: f64 = 1e-4;

fn interpolate(from: &[f64], to: &[f64], x: f64) -> f64 {
    let i = from.partition_point(|&f| f <= x).clamp(1, from.len() - 1);
    let width = from[i] - from[i - 1];
    let t = if width > 0.0 { ((x - from[i - 1]) / width).clamp(0.0, 1.0) } else { 0.0 };
    to[i - 1] + (to[i] - to[i - 1]) * t
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn breaks_ascend_from_end_to_end_however_steep_the_placement() {
        for placement in [Placement::uniform(), Placement::crowded(20.0)] {
            for cells in [1, 2, 7, 10] {
                for stretch in [-1.0, 0.0, 0.7, 1.0] {
                    let breaks = placement.breaks(cells, stretch);
                    assert_eq!((breaks.len(), breaks[0], breaks[cells]), (cells + 1, -1.0, 1.0));
                    assert!(breaks.windows(2).all(|pair| pair[0] < pair[1]), "{breaks:?}");
                    assert!(placement.basis(cells, 3, stretch).is_ok());
                }
            }
        }
    }

    #[test]
    fn a_placement_and_its_mirror_image_have_the_same_mean() {
        let lopsided = Placement { position: vec![-1.0, -0.2, 1.0], share: vec![0.0, 0.7, 1.0] };
        let symmetric = lopsided.symmetric();
        for x in [-0.9, -0.3, 0.0, 0.2, 0.55] {
            assert!((symmetric.share_below(x) + symmetric.share_below(-x) - 1.0).abs() < 1e-12);
        }
    }
}
