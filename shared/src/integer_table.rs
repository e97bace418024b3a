//! The all-integer table for targets without a floating-point unit.
//!
//! The input is the velocity as the drive has it, an `i32` in steps of [`IntegerShape::input_step`]; so is the output, in
//! steps of [`IntegerShape::output_step`]. The `2^18` steps of the reach are cut into 16 equal segments, and segment `i` into
//! `cells[i]` equal cells: many where friction bends, few beyond. A segment holds the line that takes a position to the
//! cell's number in the pool, in the upper 16 bits, and to the way `x` through the cell, in the lower 16; finding the cell is
//! thus one product and one sum. With the cell's coefficients `c0..c3` and arithmetic (flooring) shifts the value is
//!
//! ```text
//! c0 + ((x (c1 + ((x (c2 + ((x c3) >> 16))) >> 16))) >> 16)
//! ```
//!
//! Sums of coefficients of at most `2^15` keep every product within an `i32`.

use core::hint::black_box;

#[cfg(feature = "models")]
use serde::{Deserialize, Serialize};

use crate::table::Symmetry;

/// The table reaches this many input steps, as a power of two; inputs beyond hold.
pub const REACH_BITS: u32 = 18;

/// Segments of the reach; a power of two.
pub const SEGMENTS: usize = 16;

/// A segment is this many input steps wide, as a power of two.
pub const SEGMENT_BITS: u32 = REACH_BITS - SEGMENTS.ilog2();

/// Bits of the way through a cell.
pub const WAY_BITS: u32 = 16;

/// Largest magnitude of a sum of `c1`, `c2` and `c3`.
pub const MAX_COEFFICIENT: i32 = 1 << 15;

/// Largest magnitude of `c0`.
#[cfg(feature = "models")]
pub(crate) const MAX_CONSTANT: u32 = 1 << 29;

/// Most cells of a segment.
pub const MAX_SEGMENT_CELLS: u8 = 128;

/// What the image says of an integer table; everything else of [`IntegerTable`] follows from it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "models", derive(Serialize, Deserialize))]
pub struct IntegerShape {
    /// Index in the pool of the first cell for positive inputs.
    pub first_cell: u16,
    /// Cells of each segment, from zero outwards. In `1..=128`.
    pub cells: [u8; SEGMENTS],
    /// Whether the signs share cells.
    pub symmetry: Symmetry,
    /// Unit of the input for each step, positive and finite.
    pub input_step: f32,
    /// Unit of the output for each step, positive and finite.
    pub output_step: f32,
}

/// The first cell of each segment, and the one behind all; none where a segment does not have what is documented.
#[inline(always)]
pub(crate) fn segment_starts(segments: &[u8; SEGMENTS], first_cell: u16) -> Option<([u16; SEGMENTS], u32)> {
    let (mut starts, mut end, mut hold, mut index) = ([0; SEGMENTS], u32::from(first_cell), true, 0);
    while index < SEGMENTS {
        let inside = index & (SEGMENTS - 1);
        let cells = u32::from(segments[inside]);
        hold &= cells.wrapping_sub(1) < u32::from(MAX_SEGMENT_CELLS);
        starts[inside] = end as u16;
        end += cells;
        // Behind a black box the loop stays as short as it is written.
        index = black_box(index + 1);
    }
    hold.then_some((starts, end))
}

/// The largest magnitude of a cubic's value: the sum of its coefficients, and a step for each shift. None where one of the partial sums of an evaluation
/// could be too large for its product: each is at most the sum of the magnitudes behind it.
pub(crate) fn largest_value(coefficients: [i32; 4]) -> Option<u32> {
    let limit = MAX_COEFFICIENT.unsigned_abs();
    let [c0, c1, c2, c3] = coefficients.map(i32::unsigned_abs);
    let sum = c1.wrapping_add(c2).wrapping_add(c3).wrapping_add(3);
    ((c1 | c2 | c3) <= limit && sum <= limit).then_some(c0.wrapping_add(sum))
}

/// The line of a segment, modulo `2^32`: `last - short * factor` is cell and way, `short` steps before the last one of the reach.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Segment {
    /// Sixteen-bit ways for each input step.
    pub factor: u32,
    /// What the line has at the last step of the reach.
    pub last: u32,
}

/// An integer table, ready to evaluate. What an evaluation reads comes first in memory, within short offsets of a load.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "models", derive(Serialize, Deserialize), serde(from = "IntegerShape", into = "IntegerShape"))]
pub struct IntegerTable {
    /// Added to cell and way for a negative input: the cells of one side, or 0 where the signs share.
    pub negative_offset: u32,
    /// All ones where a negative input turns the sign of the output, else 0.
    pub sign_mask: i32,
    /// Segments from the reach inwards, for positive inputs.
    pub segments: [Segment; SEGMENTS],
    shape: IntegerShape,
}

impl IntegerTable {
    /// The table of a shape. A shape out of its documented range gives a harmless table, which validation refuses.
    #[must_use]
    pub fn new(shape: IntegerShape) -> Self {
        let mut segments = [Segment::default(); SEGMENTS];
        let mut first = u32::from(shape.first_cell);
        for ((segment, cells), index) in segments.iter_mut().rev().zip(shape.cells).zip(0u32..) {
            let factor = u32::from(cells) << (WAY_BITS - SEGMENT_BITS);
            let from_start_to_last = (1 << REACH_BITS) - 1 - (index << SEGMENT_BITS);
            let last = (first << WAY_BITS).wrapping_add(factor.wrapping_mul(from_start_to_last));
            *segment = Segment { factor, last };
            first += u32::from(cells);
        }
        let side = first - u32::from(shape.first_cell);
        Self {
            segments,
            negative_offset: if shape.symmetry == Symmetry::Sided { side << WAY_BITS } else { 0 },
            sign_mask: if shape.symmetry == Symmetry::Odd { -1 } else { 0 },
            shape,
        }
    }

    /// What the image says of this table.
    #[must_use]
    pub fn shape(&self) -> IntegerShape {
        self.shape
    }

    /// Cells of both signs together, counted once where they share.
    #[must_use]
    pub fn cells(&self) -> u32 {
        let side: u32 = self.shape.cells.iter().copied().map(u32::from).sum();
        if self.shape.symmetry == Symmetry::Sided { 2 * side } else { side }
    }
}

impl From<IntegerShape> for IntegerTable {
    fn from(shape: IntegerShape) -> Self {
        Self::new(shape)
    }
}

impl From<IntegerTable> for IntegerShape {
    fn from(table: IntegerTable) -> Self {
        table.shape
    }
}
