//! The all-integer table for targets without a floating-point unit.
//!
//! The input is the velocity as the drive has it, an `i32` in steps of [`IntegerShape::input_step`]; so is the output, in
//! steps of [`IntegerShape::output_step`]. Cells are of two widths: narrow ones of `2^inner_shift` steps up to
//! `2^split_shift` steps from zero, where friction bends, and wide ones of `2^outer_shift` beyond. A cell's coefficients
//! `c0..c3` are `i32`, and with the steps `x` into a cell of `2^s` the value is, with arithmetic (flooring) shifts,
//!
//! ```text
//! c0 + ((x (c1 + ((x (c2 + ((x c3) >> s))) >> s))) >> s)
//! ```
//!
//! Widths of at most `2^14` and coefficients of at most `2^16` keep every product within an `i32`.

use serde::{Deserialize, Serialize};

use crate::table::Symmetry;

/// Largest shift: cells of at most `2^14` input steps.
pub const MAX_SHIFT: u8 = 14;

/// Largest magnitude of `c1`, `c2` and `c3`; their sums stay within `2^16`.
pub const MAX_COEFFICIENT: i32 = 1 << 15;

/// Largest magnitude of the input, in steps.
pub const MAX_INPUT: u32 = 1 << 24;

/// What the image says of an integer table; everything else of [`IntegerTable`] follows from it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct IntegerShape {
    /// Index in the pool of the first cell for positive inputs.
    pub first_cell: u16,
    /// Narrow cells are `2^inner_shift` steps wide. At most [`MAX_SHIFT`].
    pub inner_shift: u8,
    /// Wide cells are `2^outer_shift` steps wide. At least `inner_shift`, at most [`MAX_SHIFT`].
    pub outer_shift: u8,
    /// Narrow cells reach to `2^split_shift` steps. At least `outer_shift`, at most 23.
    pub split_shift: u8,
    /// Whether the signs share cells.
    pub symmetry: Symmetry,
    /// Largest input in steps, at least `2^split_shift`, at most [`MAX_INPUT`].
    pub reach: u32,
    /// Unit of the input for each step, positive and finite.
    pub input_step: f32,
    /// Unit of the output for each step, positive and finite.
    pub output_step: f32,
}

/// Cells of one width.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Zone {
    /// Cells are `2^shift` steps wide.
    pub shift: u32,
    /// Index in the pool of the cell that would begin at zero, for positive inputs; modulo `2^32`.
    pub first_cell: u32,
}

/// An integer table, ready to evaluate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "IntegerShape", into = "IntegerShape")]
pub struct IntegerTable {
    shape: IntegerShape,
    /// Largest magnitude of the input that is looked up, in steps.
    pub last: u32,
    /// The zone of a magnitude `p` is 1 where `p >> split_shift` is not 0.
    pub split_shift: u32,
    /// All ones where a negative input turns the sign of the output, else 0.
    pub sign_mask: i32,
    /// Cells between a positive input's and the negative one's; 0 where they share.
    pub negative_offset: u32,
    /// Narrow and wide cells.
    pub zones: [Zone; 2],
}

impl IntegerTable {
    /// The table of a shape.
    #[must_use]
    pub fn new(shape: IntegerShape) -> Self {
        // A shape out of its documented range gives a harmless layout that validation refuses.
        let shift = |shift: u8| u32::from(shift.min(MAX_SHIFT));
        let (inner, outer) = (shift(shape.inner_shift), shift(shape.outer_shift));
        let split_shift = u32::from(shape.split_shift.min(23));
        let last = shape.reach.clamp(1, MAX_INPUT) - 1;
        let inner_cells = (1u32 << split_shift) >> inner;
        let first_cell = u32::from(shape.first_cell);
        let outer_first = first_cell.wrapping_add(inner_cells).wrapping_sub((1 << split_shift) >> outer);
        let cells = outer_first.wrapping_add(last >> outer).wrapping_add(1).wrapping_sub(first_cell);
        Self {
            shape,
            last,
            split_shift,
            sign_mask: if shape.symmetry == Symmetry::Odd { -1 } else { 0 },
            negative_offset: if shape.symmetry == Symmetry::Sided { cells } else { 0 },
            zones: [Zone { shift: inner, first_cell }, Zone { shift: outer, first_cell: outer_first }],
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
        let [_, outer] = self.zones;
        let side = outer
            .first_cell
            .wrapping_add(self.last >> outer.shift)
            .wrapping_add(1)
            .wrapping_sub(u32::from(self.shape.first_cell));
        side.wrapping_add(self.negative_offset)
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
