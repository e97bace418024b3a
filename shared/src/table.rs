//! Tables of cubic pieces: what a cell holds, and the two layouts by which an input finds its cell.
//!
//! A cell holds the coefficients `c0..c3` of `c0 + x (c1 + x (c2 + x c3))` with the local coordinate `x` in `[0, 1)`,
//! so that `c0` is exactly the value at the cell's near end. The layouts differ only in how they cut the input:
//!
//! * [`Geometric`]: cells grow with the distance from zero, where friction bends. With `w = |v| + c`, `c` a power of two,
//!   the bits of `w` minus the bits of `c` are a *position* that counts steps of equal ratio: its high part is the cell
//!   number and its low part the local coordinate. The position saturates as an unsigned integer, which also takes
//!   infinities and NaN.
//! * [`Uniform`]: equal cells over `[low, high]` by a saturating conversion to `u32` and one 32 x 32 -> 64 bit product.
//!
//! Outside its range a table holds the value at the nearer end.

use serde::{Deserialize, Serialize};

/// Mantissa bits of an `f32`.
const MANTISSA_BITS: u32 = 23;

/// Sign bit of an `f32`.
pub const SIGN_BIT: u32 = 0x8000_0000;

/// Four 32-bit words of the coefficient pool: four `f32`, or four `i32` of an integer table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(from = "[u8; 16]", into = "[u8; 16]")]
pub struct Cell([u32; 4]);

impl Cell {
    /// A cell of cubic coefficients, lowest power first.
    #[must_use]
    pub const fn from_floats(coefficients: [f32; 4]) -> Self {
        let [c0, c1, c2, c3] = coefficients;
        Self([c0.to_bits(), c1.to_bits(), c2.to_bits(), c3.to_bits()])
    }

    /// The cubic coefficients, lowest power first.
    #[must_use]
    #[inline(always)]
    pub const fn floats(&self) -> [f32; 4] {
        let [c0, c1, c2, c3] = self.0;
        [f32::from_bits(c0), f32::from_bits(c1), f32::from_bits(c2), f32::from_bits(c3)]
    }

    /// A cell of integer coefficients, lowest power first.
    #[must_use]
    pub const fn from_integers(coefficients: [i32; 4]) -> Self {
        let [c0, c1, c2, c3] = coefficients;
        Self([c0 as u32, c1 as u32, c2 as u32, c3 as u32])
    }

    /// The integer coefficients, lowest power first.
    #[must_use]
    #[inline(always)]
    pub const fn integers(&self) -> [i32; 4] {
        let [c0, c1, c2, c3] = self.0;
        [c0 as i32, c1 as i32, c2 as i32, c3 as i32]
    }
}

impl From<[u8; 16]> for Cell {
    fn from(bytes: [u8; 16]) -> Self {
        let (words, _) = bytes.as_chunks::<4>();
        let mut cell = [0; 4];
        for (word, bytes) in cell.iter_mut().zip(words) {
            *word = u32::from_le_bytes(*bytes);
        }
        Self(cell)
    }
}

impl From<Cell> for [u8; 16] {
    fn from(cell: Cell) -> Self {
        let mut bytes = [0; 16];
        let (words, _) = bytes.as_chunks_mut::<4>();
        for (bytes, word) in words.iter_mut().zip(cell.0) {
            *bytes = word.to_le_bytes();
        }
        bytes
    }
}

/// How the two signs of the input share cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Symmetry {
    /// `f(-v) = -f(v)`: one set of cells, the sign of the input goes to the output.
    Odd,
    /// `f(-v) = f(v)`: one set of cells.
    Even,
    /// Cells of their own for each sign; those for negative inputs follow the others in the pool.
    Sided,
}

/// What the image says of a geometric layout; everything else of [`Geometric`] follows from it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// Index in the pool of the cell next to zero.
    pub first_cell: u32,
    /// Largest position; inputs beyond it hold.
    pub last_position: u32,
}

/// Geometric layout, ready to evaluate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "GeometricShape", into = "GeometricShape")]
pub struct Geometric {
    shape: GeometricShape,
    /// `c` of `w = |v| + c`.
    pub offset: f32,
    /// Bits of the position below the cell number, `23 - octave_cells_log2`.
    pub shift: u32,
    /// The bits of the position that are the local coordinate.
    pub fraction_mask: u32,
    /// Local coordinate of one step of the position, `2^-shift`.
    pub fraction_step: f32,
    /// The bits of the input that are carried over to the output: the sign bit of an odd table, else none.
    pub sign_mask: u32,
    /// Cells for positive inputs, then for negative ones.
    pub sides: [Side; 2],
}

impl Geometric {
    /// The layout of a shape, for one column (a table) or for `columns` interleaved columns (the edges of a network).
    #[must_use]
    pub fn new(shape: GeometricShape) -> Self {
        // A shape out of its documented range gives a harmless layout that validation refuses.
        let exponent = i32::from(shape.offset_exponent.clamp(-60, 60));
        let offset = f32::from_bits(((exponent + 127) as u32) << MANTISSA_BITS);
        let shift = MANTISSA_BITS - u32::from(shape.octave_cells_log2.min(8));
        let last_position =
            |reach: f32| (reach.abs() + offset).to_bits().saturating_sub(offset.to_bits()).max(1).saturating_sub(1);
        let positive = Side { first_cell: u32::from(shape.first_cell), last_position: last_position(shape.reach) };
        let negative = match shape.symmetry {
            Symmetry::Odd | Symmetry::Even => positive,
            Symmetry::Sided => Side {
                first_cell: positive.first_cell + (positive.last_position >> shift) + 1,
                last_position: last_position(shape.reach_negative),
            },
        };
        Self {
            shape,
            offset,
            shift,
            fraction_mask: (1 << shift) - 1,
            fraction_step: f32::from_bits((127 - shift) << MANTISSA_BITS),
            sign_mask: if shape.symmetry == Symmetry::Odd { SIGN_BIT } else { 0 },
            sides: [positive, negative],
        }
    }

    /// What the image says of this layout.
    #[must_use]
    pub fn shape(&self) -> GeometricShape {
        self.shape
    }

    /// Cells on the side of positive and of negative inputs.
    #[must_use]
    pub fn side_cells(&self) -> [u32; 2] {
        self.sides.map(|side| (side.last_position >> self.shift) + 1)
    }

    /// Cells of both signs together, counted once where they share.
    #[must_use]
    pub fn cells(&self) -> u32 {
        let [positive, negative] = self.side_cells();
        if self.shape.symmetry == Symmetry::Sided { positive + negative } else { positive }
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(from = "UniformShape", into = "UniformShape")]
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
    /// Local coordinate of one step of the fraction, whose 24 high bits are used.
    pub const FRACTION_STEP: f32 = 1.0 / 16_777_216.0;

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
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
            Self::Geometric(layout) => layout.sides[0].first_cell,
            Self::Uniform(layout) => layout.first_cell,
        }
    }
}
