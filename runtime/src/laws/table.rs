//! Cubic tables: finding the cell, and the cubic.

#[cfg(feature = "models")]
use frikan_shared::pool::Pool;
use frikan_shared::table::{Cell, Geometric, Side, Table, Uniform};

/// Where an input lies in a table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Place {
    /// Row of cells.
    pub row: u32,
    /// Local coordinate in `[1, 2)`.
    pub t: f32,
    /// Bits that turn the output's sign.
    pub sign: u32,
}

/// The place of a position: the cell is the high word of its product with `cells`, the fraction the low one.
#[inline(always)]
pub(crate) fn place_position(position: u32, cells: u32, first_cell: u32, sign: u32) -> Place {
    let product = u64::from(position) * u64::from(cells);
    Place {
        row: first_cell.wrapping_add((product >> 32) as u32),
        t: f32::from_bits((product as u32) >> 9 | 1.0f32.to_bits()),
        sign,
    }
}

/// The biased position of `input` in a geometric layout, and its side; beyond the reach, and for NaN, the end.
#[inline(always)]
pub(crate) fn position_geometric(layout: &Geometric, input: f32) -> (u32, &Side) {
    // A sign bit is an index below 2, which the compiler knows.
    let side = &layout.sides[(input.to_bits() >> 31) as usize];
    let width = input.abs() + layout.offset;
    (width.to_bits().wrapping_sub(side.origin).min(side.last_position), side)
}

/// The position of `input` in a uniform layout; the conversion to `u32` saturates and takes NaN to the lower end.
#[inline(always)]
pub(crate) fn position_uniform(layout: &Uniform, input: f32) -> u32 {
    ((input - layout.low) * layout.scale) as u32
}

/// The place of `input` in a geometric layout.
#[inline(always)]
fn place_geometric(layout: &Geometric, input: f32) -> Place {
    let (position, side) = position_geometric(layout, input);
    place_position(position, side.cells_per_turn, 0, side.sign)
}

/// The place of `input` in a uniform layout.
#[inline(always)]
fn place_uniform(layout: &Uniform, input: f32) -> Place {
    place_position(position_uniform(layout, input), layout.cells, layout.first_cell, 0)
}

/// The place of `input` in `table`.
#[must_use]
#[inline(always)]
pub fn place(table: &Table, input: f32) -> Place {
    match table {
        Table::Geometric(layout) => place_geometric(layout, input),
        Table::Uniform(layout) => place_uniform(layout, input),
    }
}

/// `((c3 t + c2) t + c1) t + c0`, with the sign bits of the place.
#[must_use]
#[inline(always)]
pub fn cubic(cell: &Cell, place: Place) -> f32 {
    let [c0, c1, c2, c3] = cell.floats();
    let value = ((c3 * place.t + c2) * place.t + c1) * place.t + c0;
    f32::from_bits(value.to_bits() ^ place.sign)
}

/// The value of a geometric table at `input`; that at an end for NaN.
#[cfg(feature = "models")]
#[must_use]
#[inline(always)]
pub fn geometric_value<const CELLS: usize>(layout: &Geometric, pool: &Pool<CELLS>, input: f32) -> f32 {
    let place = place_geometric(layout, input);
    cubic(pool.at(place.row), place)
}

/// The value of a geometric table at `input`; 0 for NaN.
#[cfg(feature = "models")]
#[must_use]
#[inline(always)]
pub fn evaluate_geometric<const CELLS: usize>(layout: &Geometric, pool: &Pool<CELLS>, input: f32) -> f32 {
    let value = geometric_value(layout, pool, input);
    // NaN is told from the bits of |v| + c, which are at hand.
    let is_nan = (input.abs() + layout.offset).to_bits() > f32::INFINITY.to_bits();
    f32::from_bits(if is_nan { 0 } else { value.to_bits() })
}

/// The value of a single table at `input`.
#[cfg(feature = "models")]
#[must_use]
#[inline]
pub fn evaluate_table<const CELLS: usize>(table: &Table, pool: &Pool<CELLS>, input: f32) -> f32 {
    let place = place(table, input);
    cubic(pool.at(place.row), place)
}
