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
        ensure((0..self.layers.len()).all(|index| (1..=MAX_WIDTH).contains(&targets(index))), InvalidModel::NetworkShape)?;

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
