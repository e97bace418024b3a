//! Functions of one variable as an all-integer table, with a certificate of its own.
//!
//! The cubic of a cell is rounded to whole coefficients and certified as it then is, in exact arithmetic; to that come the three flooring shifts
//! of the evaluation, each at most one output step, and the rounding of the input to a step.

use frikan_shared::integer_table::{
    IntegerShape, IntegerTable, MAX_COEFFICIENT, MAX_SEGMENT_CELLS, REACH_BITS, SEGMENT_BITS, SEGMENTS,
};
use frikan_shared::table::{Cell, Symmetry};

use super::cells::{Certificate, Cubic, bound_cell, fit_cell, sampled_error};
use super::formula::{Curve, Parity};
use super::tables::TableError;

/// Most cells of a side that are tried.
const MOST_CELLS: u32 = 512;

/// Output steps by which flooring shifts can lower a value.
const FLOORING_STEPS: f64 = 3.0;

/// Output steps that partial sums leave unused, for the rounding of coefficients.
const SPARE_STEPS: i32 = 8;

/// An integer table with its cells and its certificate.
#[derive(Clone, Debug, PartialEq)]
pub struct CompiledIntegerTable {
    /// The layout; its first cell is the one asked for.
    pub table: IntegerTable,
    /// Cells in the order of the pool.
    pub cells: Vec<Cell>,
    /// Worst cell, in the unit of the output.
    pub certificate: Certificate,
}

/// Compiles `curve` on `[low, high]` into the smallest integer table whose certified error is at most `bound`, both in the unit of
/// the output. The table reaches to the larger end on both sides; between the smaller end and there it continues the curve.
///
/// # Errors
/// [`TableError::Range`], or [`TableError::Bound`] where no table of at most 512 cells a side will do.
pub fn compile_integer_table(
    curve: &dyn Curve,
    low: f64,
    high: f64,
    bound: f64,
    first_cell: u16,
) -> Result<CompiledIntegerTable, TableError> {
    if !(low < high && low.is_finite() && high.is_finite()) {
        return Err(TableError::Range { low, high });
    }
    let reach = low.abs().max(high.abs());
    let symmetry = match curve.parity() {
        Parity::Odd => Symmetry::Odd,
        Parity::Even => Symmetry::Even,
        Parity::Neither => Symmetry::Sided,
    };
    let input_step = reach / f64::from(1u32 << REACH_BITS);
    let sides = if symmetry == Symmetry::Sided { 2 } else { 1 };
    // What shifts add is known after the output step; a cell may use a little less than the bound, then ever less.
    (0..TRIES)
        .find_map(|tried| {
            let part = bound * (1.0 - f64::from(tried) / f64::from(TRIES));
            let mut cells = [0u8; SEGMENTS];
            for (count, segment) in cells.iter_mut().zip(0u32..) {
                *count = smallest_count(curve, segment, input_step, symmetry, part)?;
            }
            let side: u32 = cells.iter().copied().map(u32::from).sum();
            let shape = IntegerShape { first_cell, cells, symmetry, input_step: input_step as f32, output_step: 1.0 };
            (side * sides <= sides * MOST_CELLS).then(|| fill(curve, shape, bound)).flatten()
        })
        .ok_or(TableError::Bound { bound })
}

/// Shares of the bound that are tried, from all of it down.
const TRIES: u32 = 16;

/// Fewest equal cells of a segment with which the cubics alone stay within `bound`, by a few points of each.
fn smallest_count(curve: &dyn Curve, segment: u32, input_step: f64, symmetry: Symmetry, bound: f64) -> Option<u8> {
    (1..=MAX_SEGMENT_CELLS).find(|&count| {
        segment_edges(segment, count, input_step).all(|(near, far)| {
            let holds = |near: f64, far: f64| sampled_error(curve, near, far, &fit_cell(curve, near, far)) <= bound;
            holds(near, far) && (symmetry != Symmetry::Sided || holds(-near, -far))
        })
    })
}

/// Ends of the cells of a segment for positive inputs, in the unit of the input.
fn segment_edges(segment: u32, count: u8, input_step: f64) -> impl Iterator<Item = (f64, f64)> {
    let width = f64::from(1u32 << SEGMENT_BITS) / f64::from(count);
    let start = f64::from(segment << SEGMENT_BITS);
    let end = move |cell: u8| (start + width * f64::from(cell)) * input_step;
    (0..count).map(move |cell| (end(cell), end(cell + 1)))
}

/// Ends of the cells, in the order of the pool, in the unit of the input.
fn edges(shape: &IntegerShape) -> Vec<(f64, f64)> {
    let unit = f64::from(shape.input_step);
    let side: Vec<(f64, f64)> =
        (0u32..).zip(shape.cells).flat_map(|(segment, count)| segment_edges(segment, count, unit)).collect();
    let mirrored = side.iter().map(|&(near, far)| (-near, -far));
    match shape.symmetry {
        Symmetry::Sided => side.iter().copied().chain(mirrored).collect(),
        Symmetry::Odd | Symmetry::Even => side,
    }
}

fn fill(curve: &dyn Curve, shape: IntegerShape, bound: f64) -> Option<CompiledIntegerTable> {
    let edges = edges(&shape);
    let mut cubics: Vec<Cubic> = Vec::with_capacity(edges.len());
    for &(near, far) in &edges {
        let cubic = fit_cell(curve, near, far);
        let acceptable = sampled_error(curve, near, far, &cubic) <= bound;
        if !acceptable {
            return None;
        }
        cubics.push(cubic);
    }
    // The finest output step at which every partial sum keeps to its 16 bits and every value to its 30.
    let room = f64::from(MAX_COEFFICIENT - SPARE_STEPS);
    let values = f64::from(1u32 << 29);
    let output_step = cubics.iter().fold(1.0e-9f64, |step, [c0, c1, c2, c3]| {
        step.max((c1.abs() + c2.abs() + c3.abs()) / room).max(c0.abs() / values)
    });
    let output_step = (output_step as f32).next_up();
    let unit = f64::from(output_step);
    let shape = IntegerShape { output_step, ..shape };

    let mut worst = Certificate { approximation: 0.0, rounding: 0.0 };
    let mut cells = Vec::with_capacity(cubics.len());
    for (&(near, far), cubic) in edges.iter().zip(&cubics) {
        let whole = cubic.map(|c| (c / unit).round());
        let rounded = whole.map(|c| c * unit);
        // The input is off by half a step; the way through the cell is whole steps of it, and cut to 16 bits.
        let coordinate_error = f64::from(shape.input_step) / (far - near).abs() + 1.0 / 65_536.0;
        let (approximation, moved) = bound_cell(curve, near, far, &rounded, coordinate_error);
        let certificate = Certificate { approximation, rounding: moved + FLOORING_STEPS * unit };
        if certificate.total() > worst.total() {
            worst = certificate;
        }
        cells.push(Cell::from_integers(whole.map(|c| c as i32)));
    }
    (worst.total() <= bound).then(|| CompiledIntegerTable {
        table: IntegerTable::new(shape),
        cells,
        certificate: worst,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compile::formula::tests::stribeck_law;
    use crate::compile::formula::{Formula, Function, Operator};
    use crate::compile::reference::integer_value;
    use frikan_runtime::integer_table::{evaluate_integer, evaluate_steps};
    use frikan_shared::pool::Pool;

    #[test]
    fn the_law_of_the_paper_fits_a_thousandth_of_its_range_in_integers() {
        let sided = stribeck_law().join(Operator::Add, Formula::Input(0).apply(Function::Cos));
        for law in [stribeck_law(), sided] {
            let range = 54.0;
            let compiled = compile_integer_table(&law, -2.0, 2.0, 1.0e-3 * range, 0).unwrap();
            println!(
                "{:?}: {} cells, certified {:.4} % of range",
                compiled.table.shape(),
                compiled.cells.len(),
                100.0 * compiled.certificate.total() / range
            );
            let pool = Pool::<128>::from_slice(&compiled.cells).unwrap();
            for i in -300_000..=300_000 {
                let v = i as f32 / 100_000.0;
                let value = f64::from(evaluate_steps(&compiled.table, &pool, v));
                let want = law.value(f64::from(v.clamp(-2.0, 2.0)));
                assert!((value - want).abs() <= compiled.certificate.total(), "{v}: {value} {want}");
            }
        }
    }

    #[test]
    fn integers_agree_exactly() {
        let sided = stribeck_law().join(Operator::Add, Formula::Constant(0.3));
        for law in [stribeck_law(), sided] {
            let compiled = compile_integer_table(&law, -2.0, 2.0, 5.0e-2, 0).unwrap();
            let shape = compiled.table.shape();
            let pool = Pool::<128>::from_slice(&compiled.cells).unwrap();
            let around_the_ends = [i32::MIN, i32::MIN + 1, i32::MAX, -1, 0, 1];
            for steps in (-300_000..300_000).chain((i32::MIN..i32::MAX).step_by(40_009)).chain(around_the_ends) {
                assert_eq!(
                    evaluate_integer(&compiled.table, &pool, steps),
                    integer_value(&shape, &compiled.cells, steps),
                    "{steps}"
                );
            }
        }
    }
}
