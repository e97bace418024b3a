//! The pool of coefficients into which all tables index.

use core::fmt;
use core::ops::{Deref, DerefMut};

use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeSeq;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::table::Cell;

/// Cells for which the documented drives have room: what their firmware decodes images with.
pub const DRIVE_CELLS: usize = 128;

/// Room for `CELLS` cells, of which the first ones are used. A power of two is best: [`Pool::at`] is then one mask.
///
/// The length comes first in memory: loads with an offset are the shorter ones.
#[derive(Clone)]
#[repr(C)]
pub struct Pool<const CELLS: usize> {
    length: usize,
    cells: [Cell; CELLS],
}

/// More cells than the pool has room for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PoolFull;

impl<const CELLS: usize> Pool<CELLS> {
    /// No cells.
    #[must_use]
    pub const fn new() -> Self {
        const { assert!(CELLS > 0, "a pool has room for a cell at least") };
        Self { length: 0, cells: [Cell::ZERO; CELLS] }
    }

    /// The cells of a slice.
    ///
    /// # Errors
    /// [`PoolFull`].
    pub fn from_slice(cells: &[Cell]) -> Result<Self, PoolFull> {
        let mut pool = Self::new();
        cells.iter().try_for_each(|cell| pool.push(*cell))?;
        Ok(pool)
    }

    /// Adds a cell.
    ///
    /// # Errors
    /// [`PoolFull`].
    pub fn push(&mut self, cell: Cell) -> Result<(), PoolFull> {
        *self.cells.get_mut(self.length).ok_or(PoolFull)? = cell;
        self.length += 1;
        Ok(())
    }

    /// The cell of a row. Validation keeps the rows of a model within its cells; any other row gives some cell, so that there is
    /// nothing to check and nothing to fail.
    #[must_use]
    #[inline(always)]
    pub fn at(&self, row: u32) -> &Cell {
        let row = row as usize;
        let inside = if CELLS.is_power_of_two() { row & (CELLS - 1) } else { row.min(CELLS - 1) };
        &self.cells[inside]
    }

    /// `count` cells from a row on, `None` where they reach beyond the room.
    #[must_use]
    #[inline(always)]
    pub fn run(&self, row: u32, count: u32) -> Option<&[Cell]> {
        self.cells.get(row as usize..)?.get(..count as usize)
    }

    /// Forgets all cells after the first `length`.
    pub fn truncate(&mut self, length: usize) {
        self.length = self.length.min(length);
    }
}

impl<const CELLS: usize> Default for Pool<CELLS> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const CELLS: usize> Deref for Pool<CELLS> {
    type Target = [Cell];
    fn deref(&self) -> &[Cell] {
        self.cells.get(..self.length).unwrap_or_default()
    }
}

impl<const CELLS: usize> DerefMut for Pool<CELLS> {
    fn deref_mut(&mut self) -> &mut [Cell] {
        self.cells.get_mut(..self.length).unwrap_or_default()
    }
}

/// Cells beyond the room are left out; validation refuses a model that misses them.
impl<const CELLS: usize> FromIterator<Cell> for Pool<CELLS> {
    fn from_iter<I: IntoIterator<Item = Cell>>(cells: I) -> Self {
        let mut pool = Self::new();
        for (slot, cell) in pool.cells.iter_mut().zip(cells) {
            *slot = cell;
            pool.length += 1;
        }
        pool
    }
}

impl<const CELLS: usize> PartialEq for Pool<CELLS> {
    fn eq(&self, other: &Self) -> bool {
        **self == **other
    }
}

impl<const CELLS: usize> fmt::Debug for Pool<CELLS> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

impl<const CELLS: usize> Serialize for Pool<CELLS> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut sequence = serializer.serialize_seq(Some(self.length))?;
        self.iter().try_for_each(|cell| sequence.serialize_element(cell))?;
        sequence.end()
    }
}

impl<'de, const CELLS: usize> Deserialize<'de> for Pool<CELLS> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Cells<const CELLS: usize>;
        impl<'de, const CELLS: usize> Visitor<'de> for Cells<CELLS> {
            type Value = Pool<CELLS>;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("cells")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Pool<CELLS>, A::Error> {
                let mut pool = Pool::new();
                while let Some(cell) = sequence.next_element()? {
                    pool.push(cell).map_err(|PoolFull| A::Error::custom("too many cells"))?;
                }
                Ok(pool)
            }
        }
        deserializer.deserialize_seq(Cells)
    }
}
