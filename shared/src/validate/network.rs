//! What a network must satisfy: that its layers fit each other and its pool, and that no sum leaves its range, whatever the inputs.

use super::{InvalidModel, check_layout, ensure, rows, scale};
use crate::network::{Layer, MAX_WIDTH, Network};
use crate::table::{Cell, Symmetry, Table};

/// Ranges of the sums of a layer.
type Ranges = [(i64, i64); MAX_WIDTH];

impl Network {
    /// Checks everything that evaluation relies on, for a model of `inputs` inputs.
    ///
    /// # Errors
    /// [`InvalidModel`].
    pub fn check(&self, inputs: usize, cells: &[Cell], output_limit: f32) -> Result<(), InvalidModel> {
        ensure(self.sources().len() == inputs, InvalidModel::LawInputs)?;
        ensure(scale(self.output_step), InvalidModel::NetworkShape)?;
        let usable = |(index, layer): (usize, &Layer)| layer.rows > 0 && (1..=MAX_WIDTH).contains(&self.targets(index));
        ensure(self.layers().iter().enumerate().all(usable), InvalidModel::NetworkShape)?;

        let mut sums: Ranges = [(0, 0); MAX_WIDTH];
        for source in self.sources() {
            let turns = matches!(source.table, Table::Geometric(layout) if layout.shape().symmetry == Symmetry::Odd);
            ensure(source.table.first_cell() == 0 && !turns, InvalidModel::NetworkShape)?;
            check_layout(&source.table)?;
            let edges = rows(cells, u32::from(source.first_cell), source.table.cells(), self.targets(0))?;
            add_ranges(&mut sums, edges, self.targets(0))?;
        }
        for (layer, next) in self.layers().iter().zip(1..) {
            let columns = self.targets(next);
            let first_cell = u32::from(layer.first_row) * columns as u32;
            let edges = rows(cells, first_cell, u32::from(layer.rows), columns * layer.nodes())?;
            ensure(keep_to_rows(*layer, &sums), InvalidModel::Coefficient)?;
            sums = [(0, 0); MAX_WIDTH];
            for node in edges.chunks((usize::from(layer.rows) * columns).max(1)) {
                add_ranges(&mut sums, node, columns)?;
            }
        }
        let [output, ..] = sums;
        let largest = magnitude(output);
        ensure(largest <= i64::from(i32::MAX), InvalidModel::Coefficient)?;
        ensure(largest as f32 * self.output_step <= output_limit, InvalidModel::OutputLimit)
    }
}

/// Whether the sums of a layer keep every node's position within its rows.
fn keep_to_rows(layer: Layer, sums: &Ranges) -> bool {
    let (sums, factors) = sums.split_at(usize::from(layer.additive).min(MAX_WIDTH));
    let width = 2 * i64::from(layer.half_width());
    let sums_keep = sums.iter().enumerate().all(|(node, &(low, high))| {
        let from_start = low.wrapping_sub(i64::from(layer.start(node))).rem_euclid(1 << 32);
        from_start + (high - low) < width
    });
    let (pairs, _) = factors.as_chunks::<2>();
    let products_keep = pairs.iter().take(usize::from(layer.products)).all(|&[first, second]| {
        let (first, second) = (magnitude(first), magnitude(second));
        let fit = first.max(second) <= i64::from(i32::MAX);
        fit && ((first * second) >> 32) < i64::from(layer.half_width())
    });
    sums_keep && products_keep
}

/// The largest magnitude of a range.
fn magnitude((low, high): (i64, i64)) -> i64 {
    low.abs().max(high.abs())
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
    use crate::network::{NetworkShape, Source};
    use crate::table::{Geometric, GeometricShape, Uniform, UniformShape};
    use std::vec::Vec;

    /// Positions of a node, and the first one of the additive node.
    const WIDTH: i32 = 3 << 27;
    const START: i32 = 12 << 27;

    /// Half the range of the output.
    const HALF: i32 = 1 << 30;

    /// `[2, [1, 1], 1]` with two rows for each input and three for each node.
    fn network() -> (NetworkShape, Vec<Cell>) {
        let table = Table::Uniform(Uniform::new(UniformShape { first_cell: 0, cells: 2, low: -1.0, high: 1.0 }));
        let layer = Layer { additive: 1, products: 1, rows: 3, first_row: 12 };
        assert_eq!((layer.start(0), 2 * layer.half_width()), (START as u32, WIDTH as u32));
        let shape = NetworkShape {
            sources: [0, 6].into_iter().map(|first_cell| Source { table, first_cell }).collect(),
            layers: [layer].into_iter().collect(),
            output_step: 2.0f32.powi(-26),
        };
        let edge = [WIDTH / 4, WIDTH / 4, -WIDTH / 8, 5];
        let mut cells = Vec::from([Cell::from_integers(edge); 12]);
        for row in [0, 3] {
            cells[row] = Cell::from_integers([START + edge[0], edge[1], edge[2], edge[3]]);
        }
        cells.extend([Cell::from_integers([-HALF / 2, HALF, 0, -HALF / 16]); 6]);
        (shape, cells)
    }

    fn checked(shape: NetworkShape, inputs: usize, cells: &[Cell], output_limit: f32) -> Result<(), InvalidModel> {
        Network::new(shape).check(inputs, cells, output_limit)
    }

    fn refused(change: impl Fn(&mut NetworkShape, &mut Vec<Cell>), fault: InvalidModel) {
        let (mut shape, mut cells) = network();
        assert_eq!(checked(shape.clone(), 2, &cells, 100.0), Ok(()));
        change(&mut shape, &mut cells);
        assert_eq!(checked(shape, 2, &cells, 100.0), Err(fault));
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let (shape, cells) = network();
        assert_eq!(checked(shape.clone(), 1, &cells, 100.0), Err(InvalidModel::LawInputs));
        assert_eq!(checked(shape, 2, &cells, 1.0), Err(InvalidModel::OutputLimit));
        refused(|shape, _| shape.output_step = 0.0, InvalidModel::NetworkShape);
        refused(|shape, _| shape.layers[0].rows = 0, InvalidModel::NetworkShape);
        refused(|shape, _| shape.layers[0].products = 9, InvalidModel::NetworkShape);
        refused(|shape, _| shape.layers[0].first_row = 13, InvalidModel::CellOutOfPool);
        refused(|shape, _| shape.layers[0].first_row = u16::MAX, InvalidModel::CellOutOfPool);
        refused(|shape, _| shape.sources[1].first_cell = 60, InvalidModel::CellOutOfPool);
        let odd = GeometricShape {
            first_cell: 0,
            offset_exponent: -1,
            octave_cells_log2: 0,
            symmetry: Symmetry::Odd,
            reach: 1.0,
            reach_negative: 1.0,
        };
        refused(|shape, _| shape.sources[0].table = Table::Geometric(Geometric::new(odd)), InvalidModel::NetworkShape);
    }

    #[test]
    fn sums_that_could_leave_their_rows_are_refused() {
        // Before the rows of an additive node, behind them, and a partial sum beyond 32 bits.
        for cell in [[START - WIDTH, 0, 0, 0], [START + WIDTH, 0, 0, 0], [START, i32::MAX, i32::MAX, 0]] {
            refused(|_, cells| cells[0] = Cell::from_integers(cell), InvalidModel::Coefficient);
        }
        // A factor may be negative, but not so large that the product leaves its rows.
        let (shape, mut cells) = network();
        cells[1] = Cell::from_integers([-HALF, 0, 0, 0]);
        assert_eq!(checked(shape, 2, &cells, 100.0), Ok(()));
        refused(
            |_, cells| {
                cells[1] = Cell::from_integers([-HALF, 0, 0, 0]);
                cells[2] = Cell::from_integers([HALF, 0, 0, 0]);
            },
            InvalidModel::Coefficient,
        );
    }

    /// Sums wrap: the rows of the second half of the positions are those of negative coefficients.
    #[test]
    fn positions_beyond_half_of_all_are_accepted() {
        let (mut shape, mut cells) = network();
        shape.layers[0] = Layer { additive: 2, products: 0, ..shape.layers[0] };
        let start = shape.layers[0].start(1) as i32;
        assert!(start.checked_add(WIDTH / 2).is_none());
        // The first source's rows of two cells.
        for (cell, start) in cells.iter_mut().zip([START, start, START, start]) {
            *cell = Cell::from_integers([start + WIDTH / 4, WIDTH / 4, -WIDTH / 8, 5]);
        }
        assert_eq!(checked(shape, 2, &cells, 100.0), Ok(()));
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
