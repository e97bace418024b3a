//! What a network must satisfy: that its layers fit each other and its pool, and that no sum leaves its range, whatever the inputs.

use super::{MAX_WIDTH, Network};
use crate::table::{Cell, Symmetry, Table};
use crate::validate::{InvalidModel, check_layout, ensure, rows, scale};

/// Ranges of the sums of a layer.
type Ranges = [(i64, i64); MAX_WIDTH];

impl Network {
    /// Checks everything that evaluation relies on, for a model of `inputs` inputs.
    ///
    /// # Errors
    /// [`InvalidModel`].
    pub fn check(&self, inputs: usize, cells: &[Cell], output_limit: f32) -> Result<(), InvalidModel> {
        ensure(self.sources.len() == inputs, InvalidModel::LawInputs)?;
        ensure(scale(self.output_step), InvalidModel::NetworkShape)?;
        let targets = |index: usize| self.layers.get(index).map_or(1, |layer| layer.targets());
        ensure(
            (0..self.layers.len()).all(|index| (1..=MAX_WIDTH).contains(&targets(index))),
            InvalidModel::NetworkShape,
        )?;

        let mut sums: Ranges = [(0, 0); MAX_WIDTH];
        for source in &self.sources {
            let turns = matches!(source.table, Table::Geometric(layout) if layout.shape().symmetry == Symmetry::Odd);
            ensure(source.table.first_cell() == 0 && !turns, InvalidModel::NetworkShape)?;
            check_layout(&source.table)?;
            let edges = rows(cells, u32::from(source.first_cell), source.table.cells(), targets(0))?;
            add_ranges(&mut sums, edges, targets(0))?;
        }
        for (layer, next) in self.layers.iter().zip(1..) {
            let positive = i64::from(i32::MAX);
            for (&(low, high), index) in sums.iter().zip(0..layer.targets()) {
                let least = if index < usize::from(layer.additive) { 0 } else { -positive };
                ensure(least <= low && high <= positive, InvalidModel::Coefficient)?;
            }
            ensure(layer.rows > 0, InvalidModel::NetworkShape)?;
            let columns = targets(next);
            let edges = rows(cells, u32::from(layer.first_cell), u32::from(layer.rows), columns * layer.nodes())?;
            sums = [(0, 0); MAX_WIDTH];
            for node in edges.chunks((usize::from(layer.rows) * columns).max(1)) {
                add_ranges(&mut sums, node, columns)?;
            }
        }
        let [(low, high), ..] = sums;
        let largest = low.abs().max(high.abs());
        ensure(largest <= i64::from(i32::MAX), InvalidModel::Coefficient)?;
        ensure(largest as f32 * self.output_step <= output_limit, InvalidModel::OutputLimit)
    }
}

/// Adds the range of every column of `edges` to the sum in which it ends.
fn add_ranges(sums: &mut Ranges, edges: &[Cell], targets: usize) -> Result<(), InvalidModel> {
    for ((low, high), target) in sums.iter_mut().zip(0..targets) {
        let mut range = (i64::MAX, i64::MIN);
        for cell in edges.iter().skip(target).step_by(targets) {
            let (least, most) = cell.integer_range().ok_or(InvalidModel::Coefficient)?;
            range = (range.0.min(least), range.1.max(most));
        }
        *low = low.saturating_add(range.0);
        *high = high.saturating_add(range.1);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::network::{Layer, Source};
    use crate::table::{Geometric, GeometricShape, Uniform, UniformShape};
    use std::vec::Vec;

    /// Half the range of a sum.
    const HALF: i32 = 1 << 30;

    /// `[2, [1, 1], 1]` with two rows for each input and three for each node.
    fn network() -> (Network, Vec<Cell>) {
        let table = Table::Uniform(Uniform::new(UniformShape { first_cell: 0, cells: 2, low: -1.0, high: 1.0 }));
        let layer = Layer { additive: 1, products: 1, rows: 3, first_cell: 12 };
        let network = Network {
            sources: [0, 6].into_iter().map(|first_cell| Source { table, first_cell }).collect(),
            layers: [layer].into_iter().collect(),
            output_step: 2.0f32.powi(-26),
        };
        let mut cells = Vec::from([Cell::from_integers([HALF / 4, HALF / 4, -HALF / 8, 5]); 12]);
        cells.extend([Cell::from_integers([-HALF / 2, HALF, 0, -HALF / 16]); 6]);
        (network, cells)
    }

    fn refused(change: impl Fn(&mut Network, &mut Vec<Cell>), fault: InvalidModel) {
        let (mut network, mut cells) = network();
        assert_eq!(network.check(2, &cells, 100.0), Ok(()));
        change(&mut network, &mut cells);
        assert_eq!(network.check(2, &cells, 100.0), Err(fault));
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let (network, cells) = network();
        assert_eq!(network.check(1, &cells, 100.0), Err(InvalidModel::LawInputs));
        assert_eq!(network.check(2, &cells, 1.0), Err(InvalidModel::OutputLimit));
        refused(|network, _| network.output_step = 0.0, InvalidModel::NetworkShape);
        refused(|network, _| network.layers[0].rows = 0, InvalidModel::NetworkShape);
        refused(|network, _| network.layers[0].products = 9, InvalidModel::NetworkShape);
        refused(|network, _| network.layers[0].first_cell = 13, InvalidModel::CellOutOfPool);
        refused(|network, _| network.sources[1].first_cell = 60, InvalidModel::CellOutOfPool);
        let odd = GeometricShape {
            first_cell: 0,
            offset_exponent: -1,
            octave_cells_log2: 0,
            symmetry: Symmetry::Odd,
            reach: 1.0,
            reach_negative: 1.0,
        };
        refused(
            |network, _| network.sources[0].table = Table::Geometric(Geometric::new(odd)),
            InvalidModel::NetworkShape,
        );
    }

    #[test]
    fn sums_that_could_leave_their_range_are_refused() {
        // Below zero in an additive node, above its range, and a partial sum beyond 32 bits.
        for cell in [[-HALF, 0, 0, 0], [i32::MAX, 0, 0, 0], [0, i32::MAX, i32::MAX, 0]] {
            refused(|_, cells| cells[0] = Cell::from_integers(cell), InvalidModel::Coefficient);
        }
        // A factor may be negative.
        let (network, mut cells) = network();
        cells[1] = Cell::from_integers([-HALF, 0, 0, 0]);
        assert_eq!(network.check(2, &cells, 100.0), Ok(()));
    }

    #[test]
    fn the_range_of_a_cell_holds_every_value() {
        let cell = |seed: i64| {
            let word = |k: i64| ((seed.wrapping_mul(0x9E37_79B9_7F4A_7C15_u64 as i64) >> (8 * k)) as i32) / 4;
            Cell::from_integers([word(0), word(1), word(2), word(3)])
        };
        for seed in 1..2000 {
            let cell = cell(seed);
            let Some((low, high)) = cell.integer_range() else { continue };
            let [a0, a1, a2, a3] = cell.integers().map(i64::from);
            for x in (0..=i64::from(i32::MAX)).step_by(0x0111_1111) {
                let value = a0 + ((x * (a1 + ((x * (a2 + ((x * a3) >> 32))) >> 32))) >> 32);
                assert!((low..=high).contains(&value), "{cell:?} at {x}: {value} not in {low}..={high}");
            }
        }
    }
}
