//! B-spline bases on non-uniform grids: only the non-zero functions are evaluated, as polynomials local to a cell.

use serde::{Deserialize, Serialize};

use super::error::KanError;

/// Highest supported polynomial order of a spline edge.
pub const MAX_ORDER: usize = 5;

/// Largest number of basis functions that are non-zero at one point.
pub(in crate::kan) const MAX_SUPPORT: usize = MAX_ORDER + 1;

/// The basis functions that are non-zero at one point, with their slopes. Entries beyond the order are zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LocalBasis {
    /// Index of the first non-zero basis function.
    pub first: usize,
    /// Values of basis functions `first ..= first + order`.
    pub value: [f64; MAX_SUPPORT],
    /// Their derivatives with respect to the argument.
    pub slope: [f64; MAX_SUPPORT],
}

/// B-spline basis of order `r` on `G` cells: `G + r` functions.
///
/// Knots outside the grid mirror the spacing inside. Beyond its grid a spline continues along its tangent,
/// so that a network stays defined, continuous and bounded in slope wherever training carries its hidden values.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "Grid", into = "Grid")]
pub struct SplineBasis {
    grid: Grid,
    inverse_width: Vec<f64>,
    /// `[cell][power][function]`: coefficients of each function in the local coordinate `t` in `[0, 1]`.
    polynomials: Vec<[[f64; MAX_SUPPORT]; MAX_SUPPORT]>,
}

/// What defines a basis: its order and the boundaries of its cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Grid {
    /// Polynomial order, 1 ..= [`MAX_ORDER`].
    pub order: usize,
    /// Strictly increasing cell boundaries, at least two.
    pub breaks: Vec<f64>,
}

impl From<SplineBasis> for Grid {
    fn from(basis: SplineBasis) -> Self {
        basis.grid
    }
}

impl TryFrom<Grid> for SplineBasis {
    type Error = KanError;

    fn try_from(grid: Grid) -> Result<Self, KanError> {
        Self::new(grid)
    }
}

impl SplineBasis {
    /// Builds the basis of a grid.
    ///
    /// # Errors
    /// [`KanError::Grid`] when the order is out of range or the breaks are not finite and strictly increasing.
    pub fn new(grid: Grid) -> Result<Self, KanError> {
        let ascending = grid.breaks.windows(2).all(|pair| pair[0] < pair[1]);
        let finite = grid.breaks.iter().all(|b| b.is_finite());
        if grid.order == 0 || grid.order > MAX_ORDER || grid.breaks.len() < 2 || !ascending || !finite {
            return Err(KanError::Grid { order: grid.order, cells: grid.breaks.len().saturating_sub(1) });
        }
        let knots = mirrored_knots(&grid);
        let cells = grid.breaks.len() - 1;
        let polynomials = (0..cells).map(|cell| cell_polynomials(&knots, grid.order, cell)).collect();
        let inverse_width = grid.breaks.windows(2).map(|pair| 1.0 / (pair[1] - pair[0])).collect();
        Ok(Self { grid, inverse_width, polynomials })
    }

    /// A grid of equal cells over `[low, high]`.
    ///
    /// # Errors
    /// As [`SplineBasis::new`].
    pub fn uniform(low: f64, high: f64, cells: usize, order: usize) -> Result<Self, KanError> {
        let breaks = (0..=cells).map(|i| low + (high - low) * i as f64 / cells.max(1) as f64).collect();
        Self::new(Grid { order, breaks })
    }

    /// Number of basis functions, cells plus order.
    pub fn len(&self) -> usize {
        self.polynomials.len() + self.grid.order
    }

    /// Never true: a basis has at least two functions.
    pub fn is_empty(&self) -> bool {
        false
    }

    /// Polynomial order.
    pub fn order(&self) -> usize {
        self.grid.order
    }

    /// Cell boundaries, ascending.
    pub fn breaks(&self) -> &[f64] {
        &self.grid.breaks
    }

    /// Abscissae at which coefficients equal to the abscissa reproduce the identity (Greville).
    pub fn greville(&self) -> Vec<f64> {
        let knots = mirrored_knots(&self.grid);
        let order = self.grid.order;
        (0..self.len()).map(|i| knots[i + 1..=i + order].iter().sum::<f64>() / order as f64).collect()
    }

    /// The non-zero functions and their slopes at `x`; outside the grid their tangents at the nearer end.
    #[inline]
    pub fn at(&self, x: f64) -> LocalBasis {
        // A length known to the compiler lets it keep the functions in vector registers.
        match self.grid.order {
            1 => self.local::<2>(x),
            2 => self.local::<3>(x),
            3 => self.local::<4>(x),
            4 => self.local::<5>(x),
            _ => self.local::<MAX_SUPPORT>(x),
        }
    }

    #[inline]
    fn local<const SUPPORT: usize>(&self, x: f64) -> LocalBasis {
        let breaks = &self.grid.breaks;
        let last = self.polynomials.len() - 1;
        let cell = breaks[1..=last].partition_point(|&b| b <= x);
        let inverse_width = self.inverse_width[cell];
        let position = (x - breaks[cell]) * inverse_width;
        let t = position.clamp(0.0, 1.0);
        let beyond = position - t;

        let by_power = |power: usize| -> &[f64; MAX_SUPPORT] { &self.polynomials[cell][power] };
        let (mut value, mut slope) = ([0.0; SUPPORT], [0.0; SUPPORT]);
        value.copy_from_slice(&by_power(SUPPORT - 1)[..SUPPORT]);
        for power in (0..SUPPORT - 1).rev() {
            let coefficients = by_power(power);
            for i in 0..SUPPORT {
                slope[i] = slope[i] * t + value[i];
                value[i] = value[i] * t + coefficients[i];
            }
        }
        let mut local = LocalBasis { first: cell, ..LocalBasis::default() };
        for i in 0..SUPPORT {
            local.value[i] = value[i] + slope[i] * beyond;
            local.slope[i] = slope[i] * inverse_width;
        }
        local
    }
}

/// The grid's breaks with `order` more knots at each end, at the spacing mirrored from inside.
fn mirrored_knots(grid: &Grid) -> Vec<f64> {
    let (breaks, order) = (&grid.breaks, grid.order);
    let last = breaks.len() - 1;
    let mut knots = Vec::with_capacity(breaks.len() + 2 * order);
    // Fewer cells than the order: go on at the mean spacing.
    let mean = (breaks[last] - breaks[0]) / last as f64;
    let past = |k: usize| k.saturating_sub(last) as f64 * mean;
    knots.extend((1..=order).rev().map(|k| 2.0 * breaks[0] - breaks[k.min(last)] - past(k)));
    knots.extend_from_slice(breaks);
    knots.extend((1..=order).map(|k| 2.0 * breaks[last] - breaks[last - k.min(last)] + past(k)));
    knots
}

/// Cox-de Boor recursion (de Boor, 1972) carried out on polynomials in the local coordinate of one cell.
fn cell_polynomials(knots: &[f64], order: usize, cell: usize) -> [[f64; MAX_SUPPORT]; MAX_SUPPORT] {
    let left = knots[cell + order];
    let width = knots[cell + order + 1] - left;
    // functions[i][power]; before step `degree` the first `degree` functions are the non-zero ones.
    let mut functions = [[0.0; MAX_SUPPORT]; MAX_SUPPORT];
    functions[0][0] = 1.0;
    for degree in 1..=order {
        let mut raised = [[0.0; MAX_SUPPORT]; MAX_SUPPORT];
        for i in 0..degree {
            let start = knots[cell + order + 1 + i - degree];
            let end = knots[cell + order + 1 + i];
            let span = end - start;
            for power in 0..degree {
                let share = functions[i][power] / span;
                raised[i + 1][power] += share * (left - start);
                raised[i + 1][power + 1] += share * width;
                raised[i][power] += share * (end - left);
                raised[i][power + 1] -= share * width;
            }
        }
        functions = raised;
    }
    let mut by_power = [[0.0; MAX_SUPPORT]; MAX_SUPPORT];
    for (i, function) in functions.iter().enumerate() {
        for (power, &coefficient) in function.iter().enumerate() {
            by_power[power][i] = coefficient;
        }
    }
    by_power
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The textbook recursion on values, function by function.
    fn cox_de_boor(knots: &[f64], i: usize, degree: usize, x: f64) -> f64 {
        if degree == 0 {
            return if knots[i] <= x && x < knots[i + 1] { 1.0 } else { 0.0 };
        }
        let rising = (x - knots[i]) / (knots[i + degree] - knots[i]);
        let falling = (knots[i + degree + 1] - x) / (knots[i + degree + 1] - knots[i + 1]);
        rising * cox_de_boor(knots, i, degree - 1, x) + falling * cox_de_boor(knots, i + 1, degree - 1, x)
    }

    fn grids() -> impl Strategy<Value = Grid> {
        (1..=MAX_ORDER, prop::collection::vec(0.01..1.0f64, 1..15)).prop_map(|(order, widths)| {
            let mut breaks = vec![-1.3];
            for width in widths {
                breaks.push(breaks[breaks.len() - 1] + width);
            }
            Grid { order, breaks }
        })
    }

    proptest! {
        #[test]
        fn agrees_with_the_textbook_recursion(grid in grids(), share in 0.0..1.0f64) {
            let basis = SplineBasis::new(grid.clone()).unwrap();
            let (low, high) = (grid.breaks[0], grid.breaks[grid.breaks.len() - 1]);
            let x = low + share * (high - low) * (1.0 - 1e-12);
            let knots = mirrored_knots(&grid);
            let local = basis.at(x);
            for i in 0..basis.len() {
                let ours = if i >= local.first && i <= local.first + grid.order { local.value[i - local.first] } else { 0.0 };
                prop_assert!((ours - cox_de_boor(&knots, i, grid.order, x)).abs() < 1e-10);
            }
        }

        #[test]
        fn sums_to_one_and_reproduces_the_identity_everywhere(grid in grids(), x in -5.0..20.0f64) {
            let basis = SplineBasis::new(grid).unwrap();
            let local = basis.at(x);
            prop_assert!((local.value.iter().sum::<f64>() - 1.0).abs() < 1e-9);
            prop_assert!(local.slope.iter().sum::<f64>().abs() < 1e-9);
            let greville = basis.greville();
            let identity: f64 = (0..=basis.order()).map(|i| local.value[i] * greville[local.first + i]).sum();
            prop_assert!((identity - x).abs() < 1e-9 * (1.0 + x.abs()));
        }

        #[test]
        fn slopes_agree_with_differences(grid in grids(), share in -0.2..1.2f64) {
            let basis = SplineBasis::new(grid.clone()).unwrap();
            let (low, high) = (grid.breaks[0], grid.breaks[grid.breaks.len() - 1]);
            let x = low + share * (high - low);
            let step = 1e-7;
            prop_assume!(grid.breaks.iter().all(|b| (b - x).abs() > 2.0 * step));
            let (below, here, above) = (basis.at(x - step), basis.at(x), basis.at(x + step));
            for i in 0..MAX_SUPPORT {
                let difference = (above.value[i] - below.value[i]) / (2.0 * step);
                prop_assert!((difference - here.slope[i]).abs() < 1e-4 * (1.0 + difference.abs()));
            }
        }
    }

    #[test]
    fn refuses_grids_that_are_not_grids() {
        for (order, breaks) in [
            (0, vec![0.0, 1.0]),
            (MAX_ORDER + 1, vec![0.0, 1.0]),
            (3, vec![0.0]),
            (3, vec![0.0, 0.0]),
            (3, vec![0.0, f64::NAN]),
        ] {
            assert!(SplineBasis::new(Grid { order, breaks }).is_err());
        }
    }
}
