//! Functions of one variable as the smallest table that meets a stated bound.
//!
//! Both layouts are tried; within each the sizes from small to large. A candidate is looked at in a few points first and
//! certified only when it stands. The result carries the certificate of its worst cell (see [`super::cells`]).

use frikan_shared::table::{Cell, Geometric, GeometricShape, Symmetry, Table, Uniform, UniformShape};
use thiserror::Error;

use super::cells::{Certificate, certify, fit_cell, sampled_error, to_drive};
use super::formula::{Curve, Parity};

/// Most cells of a side that are tried.
const MOST_CELLS: u32 = 1024;

/// Why a function did not become a table.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum TableError {
    /// The range is empty or not finite.
    #[error("the range [{low}, {high}] cannot hold a table")]
    Range {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// No table of a permitted size meets the bound.
    #[error("no table of at most {MOST_CELLS} cells has a certified error of at most {bound}")]
    Bound {
        /// The bound asked for, in the unit of the output.
        bound: f64,
    },
}

/// A table with its cells and its certificate.
#[derive(Clone, Debug, PartialEq)]
pub struct CompiledTable {
    /// The layout; its first cell is the one asked for.
    pub table: Table,
    /// Cells in the order of the pool.
    pub cells: Vec<Cell>,
    /// Worst cell, in the unit of the output.
    pub certificate: Certificate,
    /// Cells of the table.
    pub per_cell: Vec<Certificate>,
}

impl CompiledTable {
    /// The smallest output limit with which a model of this table alone is valid, in the unit of the output.
    #[must_use]
    pub fn output_bound(&self) -> f32 {
        self.cells.iter().fold(0.0, |most, cell| most.max(cell.bound()))
    }
}

/// A candidate: its layout, and the ends of each cell in the order of the pool.
struct Candidate {
    table: Table,
    edges: Vec<(f64, f64)>,
    coordinate_error: f64,
}

/// Compiles `curve` on `[low, high]` into the smallest table whose certified error is at most `bound`, both in the unit of the
/// output. `first_cell` is where the caller's pool will have the table.
///
/// A curve that shows itself odd or even shares cells between the signs, and its table reaches to the larger end on both.
///
/// # Errors
/// [`TableError::Range`], or [`TableError::Bound`] where no table of at most 1024 cells a side will do.
pub fn compile_table(
    curve: &dyn Curve,
    low: f64,
    high: f64,
    bound: f64,
    first_cell: u16,
) -> Result<CompiledTable, TableError> {
    if !(low < high && low.is_finite() && high.is_finite()) {
        return Err(TableError::Range { low, high });
    }
    let mut candidates = geometric_candidates(curve.parity(), low, high, first_cell);
    candidates.extend((0..=10).flat_map(|octave| {
        // 1, 2, 3, 4, 6, 8, 12, ...
        let power = 1u32 << octave;
        [Some(power), (octave > 0).then_some(power + power / 2)]
            .into_iter()
            .flatten()
            .filter(|cells| *cells <= MOST_CELLS)
            .map(|cells| uniform_candidate(low, high, cells, first_cell))
            .collect::<Vec<_>>()
    }));
    // The order among equals is fixed, so that a compilation is repeatable.
    candidates.sort_by_key(|candidate| candidate.edges.len());
    candidates.iter().find_map(|candidate| fill(curve, candidate, bound)).ok_or(TableError::Bound { bound })
}

/// Compiles `curve` into a table of the given layout, whatever its error; the certificate says what came of it.
#[must_use]
pub fn compile_layout(curve: &dyn Curve, table: Table) -> CompiledTable {
    let candidate = candidate(table);
    certified(curve, candidate.table, &candidate.edges, &fitted(curve, &candidate.edges), candidate.coordinate_error)
}

/// Ends of the rows of a layout in the order of the pool, and the largest error of the local coordinate.
#[must_use]
pub fn rows(table: Table) -> (Vec<(f64, f64)>, f64) {
    let candidate = candidate(table);
    (candidate.edges, candidate.coordinate_error)
}

fn candidate(table: Table) -> Candidate {
    match table {
        Table::Geometric(layout) => geometric_candidate(layout),
        Table::Uniform(layout) => uniform_layout(layout),
    }
}

fn fitted(curve: &dyn Curve, edges: &[(f64, f64)]) -> Vec<[f32; 4]> {
    edges.iter().map(|&(near, far)| to_drive(fit_cell(curve, near, far))).collect()
}

fn fill(curve: &dyn Curve, candidate: &Candidate, bound: f64) -> Option<CompiledTable> {
    let mut cubics = Vec::with_capacity(candidate.edges.len());
    for &(near, far) in &candidate.edges {
        let cubic = fit_cell(curve, near, far);
        let acceptable = sampled_error(curve, near, far, &cubic) <= bound;
        if !acceptable {
            return None;
        }
        cubics.push(to_drive(cubic));
    }
    let compiled = certified(curve, candidate.table, &candidate.edges, &cubics, candidate.coordinate_error);
    (compiled.certificate.total() <= bound).then_some(compiled)
}

fn certified(
    curve: &dyn Curve,
    table: Table,
    edges: &[(f64, f64)],
    cubics: &[[f32; 4]],
    coordinate_error: f64,
) -> CompiledTable {
    let per_cell: Vec<Certificate> = edges
        .iter()
        .zip(cubics)
        .map(|(&(near, far), cubic)| certify(curve, near, far, cubic, coordinate_error))
        .collect();
    let certificate = per_cell.iter().fold(Certificate { approximation: 0.0, rounding: 0.0 }, |worst, cell| {
        if cell.total() > worst.total() { *cell } else { worst }
    });
    // Negative odd inputs turn the sign of the output; nothing else of the cubic depends on the side.
    CompiledTable {
        table,
        cells: cubics.iter().map(|cubic| Cell::from_floats(*cubic)).collect(),
        certificate,
        per_cell,
    }
}

fn geometric_candidates(parity: Parity, low: f64, high: f64, first_cell: u16) -> Vec<Candidate> {
    let (symmetry, reach, reach_negative) = match parity {
        Parity::Odd => (Symmetry::Odd, low.abs().max(high.abs()), low.abs().max(high.abs())),
        Parity::Even => (Symmetry::Even, low.abs().max(high.abs()), low.abs().max(high.abs())),
        Parity::Neither if low < 0.0 && high > 0.0 => (Symmetry::Sided, high, -low),
        // A range on one side of zero gains nothing from cells that shrink towards zero.
        Parity::Neither => return Vec::new(),
    };
    let coarsest = (reach.log2().floor() as i32).clamp(-40, 40);
    let mut candidates = Vec::new();
    for octave_cells_log2 in 0..=5u8 {
        for offset_exponent in (coarsest - 14..=coarsest).rev() {
            let shape = GeometricShape {
                first_cell,
                offset_exponent: offset_exponent as i8,
                octave_cells_log2,
                symmetry,
                reach: reach as f32,
                reach_negative: reach_negative as f32,
            };
            let layout = Geometric::new(shape);
            if layout.fits() && layout.side_cells().into_iter().all(|cells| cells <= MOST_CELLS) {
                candidates.push(geometric_candidate(layout));
            }
        }
    }
    candidates
}

fn geometric_candidate(layout: Geometric) -> Candidate {
    let (offset, shift) = (layout.offset.to_bits(), layout.shape().shift());
    let edge = |cell: u32| f64::from(f32::from_bits(offset + (cell << shift))) - f64::from(layout.offset);
    let [positive, negative] = layout.side_cells();
    let mut edges: Vec<(f64, f64)> = (0..positive).map(|cell| (edge(cell), edge(cell + 1))).collect();
    if layout.shape().symmetry == Symmetry::Sided {
        edges.extend((0..negative).map(|cell| (-edge(cell), -edge(cell + 1))));
    }
    // |v| + c is rounded to half a step of the position; the last position is one step short of the reach.
    let coordinate_error = 1.5 / f64::from(1u32 << shift);
    Candidate { table: Table::Geometric(layout), edges, coordinate_error }
}

fn uniform_candidate(low: f64, high: f64, cells: u32, first_cell: u16) -> Candidate {
    uniform_layout(Uniform::new(UniformShape { first_cell, cells: cells as u16, low: low as f32, high: high as f32 }))
}

fn uniform_layout(layout: Uniform) -> Candidate {
    let shape = layout.shape();
    let (low, high) = (f64::from(shape.low), f64::from(shape.high));
    let count = f64::from(layout.cells);
    let edge = |cell: u32| low + (high - low) * f64::from(cell) / count;
    let edges = (0..layout.cells).map(|cell| (edge(cell), edge(cell + 1))).collect();
    // Difference, scale (two operations) and product each round once; the fraction is cut to 23 bits.
    let coordinate_error = (4.0 * count + 4.0) / 16_777_216.0;
    Candidate { table: Table::Uniform(layout), edges, coordinate_error }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::formula::tests::stribeck_law;
    use crate::compile::formula::{Formula, Function, Operator};
    use frikan_runtime::table::evaluate_table;
    use frikan_shared::pool::Pool;

    /// Largest error of the table as the drive computes it, sampled.
    fn observed(curve: &dyn Curve, compiled: &CompiledTable, low: f32, high: f32) -> f64 {
        let pool = Pool::<256>::from_slice(&compiled.cells).unwrap();
        (0..=200_000u32)
            .map(|i| low + (high - low) * (i as f32 / 200_000.0))
            .map(|v| {
                let got = evaluate_table(&compiled.table, &pool, v);
                (f64::from(got) - curve.value(f64::from(v))).abs()
            })
            .fold(0.0, f64::max)
    }

    #[test]
    fn twenty_eight_geometric_cells_hold_the_law_of_the_paper() {
        let law = stribeck_law();
        let layout = Geometric::new(GeometricShape {
            first_cell: 0,
            offset_exponent: -6,
            octave_cells_log2: 2,
            symmetry: Symmetry::Odd,
            reach: 2.0,
            reach_negative: 2.0,
        });
        let compiled = compile_layout(&law, Table::Geometric(layout));
        let range = 2.0 * 27.0;
        println!(
            "{} cells, certified {:?}, {:.6} % of range, observed {:e}",
            compiled.cells.len(),
            compiled.certificate,
            100.0 * compiled.certificate.total() / range,
            observed(&law, &compiled, -2.0, 2.0)
        );
        assert!(compiled.cells.len() <= 29);
        assert!(compiled.certificate.total() / range < 2.0e-5);
    }

    #[test]
    fn certificates_bound_what_is_observed_and_are_not_far_from_it() {
        let law = stribeck_law();
        let sided = law.clone().join(
            Operator::Add,
            Formula::Input(0)
                .apply(Function::Cos)
                .join(Operator::Multiply, Formula::Constant(2.0))
                .join(Operator::Multiply, Formula::Input(0).apply(Function::Atan).apply(Function::Exp)),
        );
        let smooth = Formula::Input(0).apply(Function::Sin).join(Operator::Add, Formula::Constant(0.25));
        for (curve, low, high) in [(&law, -2.0, 2.0), (&sided, -2.0, 1.5), (&smooth, 0.5, 3.0)] {
            for bound in [1.0e-2, 1.0e-3, 3.0e-4] {
                let compiled = compile_table(curve, low, high, bound, 0).unwrap();
                let observed = observed(curve, &compiled, low as f32, high as f32);
                println!(
                    "{bound:e}: {} cells, {:?}, observed {observed:e}",
                    compiled.cells.len(),
                    compiled.certificate
                );
                assert!(observed <= compiled.certificate.total());
                assert!(compiled.certificate.total() <= 2.0 * observed + 2.0e-5);
                assert!(compiled.certificate.total() <= bound);
            }
        }
    }

    #[test]
    fn impossible_demands_are_refused() {
        let law = stribeck_law();
        assert!(matches!(compile_table(&law, 1.0, 1.0, 1.0e-3, 0), Err(TableError::Range { .. })));
        assert!(matches!(compile_table(&law, -2.0, 2.0, 1.0e-12, 0), Err(TableError::Bound { .. })));
    }
}
