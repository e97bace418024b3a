//! Tables of cubic pieces: what a cell holds, and the two layouts by which an input finds its cell.
//!
//! A cell holds the coefficients `c0..c3` of `((c3 t + c2) t + c1) t + c0` with the local coordinate `t` in `[1, 2)`: 1 at the
//! cell's near end, 2 at its far end. That range costs nothing: the 23 bits of the fraction of the way through the cell,
//! or-ed into the pattern of 1.0, *are* `t`, exactly. The layouts differ only in how they cut the input:
//!
//! * [`Geometric`]: cells grow with the distance from zero, where friction bends. With `w = |v| + c`, `c` a power of two,
//!   the bits of `w` minus the bits of `c` are a *position* that counts steps of equal ratio: its high part is the cell
//!   number and its low part the local coordinate. The position saturates as an unsigned integer, which also takes
//!   infinities and NaN.
//! * [`Uniform`]: equal cells over `[low, high]`, the position a saturating conversion to `u32`.
//!
//! In both, one 32 x 32 -> 64 bit product of the position gives the cell in the high word and the fraction in the low one, of
//! which the upper 23 bits are used.
//!
//! Outside its range a table holds the value at the nearer end.

#[cfg(feature = "models")]
use serde::{Deserialize, Serialize};

use crate::invalid::scale;

mod cell;

pub(crate) use cell::is_usable;
pub use cell::{Cell, SIGN_BIT};

/// Mantissa bits of an `f32`.
const MANTISSA_BITS: u32 = 23;

/// How the two signs of the input share cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "models", derive(Serialize, Deserialize))]
pub enum Symmetry {
    /// `f(-v) = -f(v)`: one set of cells, the sign of the input goes to the output.
    Odd,
    /// `f(-v) = f(v)`: one set of cells.
    Even,
    /// Cells of their own for each sign; those for negative inputs follow the others in the pool.
    Sided,
}

/// What the image says of a geometric layout; everything else of [`Geometric`] follows from it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "models", derive(Serialize, Deserialize))]
pub struct GeometricShape {
    /// Index in the pool of the first cell for positive inputs.
    pub first_cell: u16,
    /// `c = 2^offset_exponent`, in the unit of the input: the width within which cells stop shrinking. In `-60..=60`.
    pub offset_exponent: i8,
    /// `2^octave_cells_log2` cells for each doubling of `|v| + c`. In `0..=8`.
    pub octave_cells_log2: u8,
    /// Whether the signs share cells.
    pub symmetry: Symmetry,
    /// Largest input of the table, positive and finite, in the unit of the input.
    pub reach: f32,
    /// Magnitude of the most negative input of a [`Symmetry::Sided`] table; equal to `reach` otherwise.
    pub reach_negative: f32,
}

/// The cells of one sign.
///
/// Positions are biased: they begin at `first_cell << shift`, so that the cell number that comes out is already one of the pool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// What is taken from the bits of `|v| + c` to get the biased position.
    pub origin: u32,
    /// Largest biased position; inputs beyond it hold.
    pub last_position: u32,
    /// `2^32 / 2^shift`: the product of a position with it has the cell in the high word and the fraction in the low one.
    pub cells_per_turn: u32,
    /// The bits that this side turns in the output: the sign bit for negative inputs of an odd table, else none.
    pub sign: u32,
}

/// Geometric layout, ready to evaluate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "models", derive(Serialize, Deserialize), serde(from = "GeometricShape", into = "GeometricShape"))]
pub struct Geometric {
    shape: GeometricShape,
    /// `c` of `w = |v| + c`.
    pub offset: f32,
    /// Positive inputs, then negative ones.
    pub sides: [Side; 2],
}

impl Geometric {
    /// The layout of a shape. A shape out of its documented range gives a harmless layout, which validation refuses.
    #[must_use]
    #[inline(always)]
    pub fn new(shape: GeometricShape) -> Self {
        let exponent = i32::from(shape.offset_exponent.clamp(-60, 60));
        let offset = f32::from_bits(((exponent + 127) as u32) << MANTISSA_BITS);
        let shift = shape.shift();
        // One step short of the end, so that the end is still in the last cell.
        let last = |reach: f32| (reach.abs() + offset).to_bits().wrapping_sub(offset.to_bits()).saturating_sub(1);
        let side = |first_cell: u32, last: u32| {
            let bias = first_cell << shift;
            Side {
                origin: offset.to_bits().wrapping_sub(bias),
                last_position: bias.wrapping_add(last),
                cells_per_turn: 1 << (32 - shift),
                sign: 0,
            }
        };
        let first_cell = u32::from(shape.first_cell);
        let last_positive = last(shape.reach);
        let positive = side(first_cell, last_positive);
        let negative = if shape.symmetry == Symmetry::Sided {
            side(first_cell + (last_positive >> shift) + 1, last(shape.reach_negative))
        } else {
            positive
        };
        let sign = if shape.symmetry == Symmetry::Odd { SIGN_BIT } else { 0 };
        let negative = Side { sign, ..negative };
        Self { shape, offset, sides: [positive, negative] }
    }

    /// What the image says of this layout.
    #[must_use]
    pub fn shape(&self) -> GeometricShape {
        self.shape
    }

    /// Cells on the side of positive and of negative inputs.
    #[must_use]
    pub fn side_cells(&self) -> [u32; 2] {
        let shift = self.shape.shift();
        let offset = self.offset.to_bits();
        // The positions without their bias.
        self.sides.map(|side| (side.last_position.wrapping_sub(offset.wrapping_sub(side.origin)) >> shift) + 1)
    }

    /// Cells of both signs together, counted once where they share.
    #[must_use]
    pub fn cells(&self) -> u32 {
        let [positive, negative] = self.side_cells();
        if self.shape.symmetry == Symmetry::Sided { positive + negative } else { positive }
    }

    /// Whether every biased position fits in 32 bits.
    #[must_use]
    #[inline]
    pub fn fits(&self) -> bool {
        u32::from(self.shape.first_cell) + self.cells() <= u32::MAX >> self.shape.shift()
    }
}

impl GeometricShape {
    /// Whether all numbers are in their documented range.
    #[must_use]
    #[inline]
    pub fn is_within_range(&self) -> bool {
        (-60..=60).contains(&self.offset_exponent)
            && self.octave_cells_log2 <= 8
            && scale(self.reach)
            && scale(self.reach_negative)
    }

    /// Bits of a position below the cell number.
    #[must_use]
    pub fn shift(&self) -> u32 {
        MANTISSA_BITS - u32::from(self.octave_cells_log2.min(8))
    }
}

impl From<GeometricShape> for Geometric {
    fn from(shape: GeometricShape) -> Self {
        Self::new(shape)
    }
}

impl From<Geometric> for GeometricShape {
    fn from(layout: Geometric) -> Self {
        layout.shape
    }
}

/// What the image says of a uniform layout; everything else of [`Uniform`] follows from it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "models", derive(Serialize, Deserialize))]
pub struct UniformShape {
    /// Index in the pool of the cell at `low`.
    pub first_cell: u16,
    /// Number of cells, at least 1.
    pub cells: u16,
    /// Lower end of the range, finite, in the unit of the input.
    pub low: f32,
    /// Upper end of the range, finite, greater than `low`.
    pub high: f32,
}

/// Uniform layout, ready to evaluate.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "models", derive(Serialize, Deserialize), serde(from = "UniformShape", into = "UniformShape"))]
pub struct Uniform {
    shape: UniformShape,
    /// Lower end of the range.
    pub low: f32,
    /// `2^32 / (high - low)`, rounded to `f32`.
    pub scale: f32,
    /// Number of cells.
    pub cells: u32,
    /// Index in the pool of the cell at `low`.
    pub first_cell: u32,
}

impl Uniform {
    /// The layout of a shape.
    #[must_use]
    pub fn new(shape: UniformShape) -> Self {
        Self {
            shape,
            low: shape.low,
            scale: 4_294_967_296.0 / (shape.high - shape.low),
            cells: u32::from(shape.cells),
            first_cell: u32::from(shape.first_cell),
        }
    }

    /// What the image says of this layout.
    #[must_use]
    pub fn shape(&self) -> UniformShape {
        self.shape
    }
}

impl From<UniformShape> for Uniform {
    fn from(shape: UniformShape) -> Self {
        Self::new(shape)
    }
}

impl From<Uniform> for UniformShape {
    fn from(layout: Uniform) -> Self {
        layout.shape
    }
}

/// A function of one input as cubic pieces in the pool.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "models", derive(Serialize, Deserialize))]
pub enum Table {
    /// Cells that grow with the distance from zero.
    Geometric(Geometric),
    /// Equal cells.
    Uniform(Uniform),
}

impl Table {
    /// Cells that one column of the table takes in the pool.
    #[must_use]
    pub fn cells(&self) -> u32 {
        match self {
            Self::Geometric(layout) => layout.cells(),
            Self::Uniform(layout) => layout.cells,
        }
    }

    /// Index in the pool of the table's first cell.
    #[must_use]
    pub fn first_cell(&self) -> u32 {
        match self {
            Self::Geometric(layout) => u32::from(layout.shape().first_cell),
            Self::Uniform(layout) => layout.first_cell,
        }
    }
}
