//! Cells of the pool of coefficients.

#[cfg(feature = "models")]
use serde::{Deserialize, Serialize};

use crate::invalid::LARGEST;

/// Sign bit of an `f32`.
pub const SIGN_BIT: u32 = 0x8000_0000;

/// Four 32-bit words of the coefficient pool: four `f32`, or four `i32` of an integer table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
#[cfg_attr(feature = "models", derive(Serialize, Deserialize), serde(from = "[u8; 16]", into = "[u8; 16]"))]
pub struct Cell([u32; 4]);

impl Cell {
    /// All words zero.
    pub const ZERO: Self = Self([0; 4]);

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

    /// A bound of the cubic's magnitude on `[1, 2]` as the drive computes it: the largest of its Bernstein coefficients, and for the
    /// rounding of the evaluation (and of these coefficients) a few units in the last place of its terms.
    #[must_use]
    pub fn bound(&self) -> f32 {
        let [c0, c1, c2, c3] = self.floats();
        let bernstein = [
            c0 + c1 + c2 + c3,
            c0 + (4.0 * c1 + 5.0 * c2 + 6.0 * c3) / 3.0,
            c0 + (5.0 * c1 + 8.0 * c2 + 12.0 * c3) / 3.0,
            c0 + 2.0 * c1 + 4.0 * c2 + 8.0 * c3,
        ];
        let rounding = 8.0 * f32::EPSILON * (c0.abs() + 2.0 * c1.abs() + 4.0 * c2.abs() + 8.0 * c3.abs());
        bernstein
            .into_iter()
            .fold(0.0f32, |most, coefficient| if coefficient.abs() > most { coefficient.abs() } else { most })
            + rounding
    }

    /// Whether a cubic of these coefficients may be evaluated: none is infinite, NaN, subnormal or too large.
    #[must_use]
    pub fn is_usable(&self) -> bool {
        self.0.into_iter().all(is_usable)
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

/// Whether a coefficient of this pattern is of use: it is 0 or normal, and not too large.
#[inline]
pub(crate) fn is_usable(word: u32) -> bool {
    // Patterns order magnitudes, and one less than 0 lies beyond all subnormal ones.
    let magnitude = word & !SIGN_BIT;
    magnitude <= LARGEST.to_bits() && magnitude.wrapping_sub(1) >= f32::MIN_POSITIVE.to_bits() - 1
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
