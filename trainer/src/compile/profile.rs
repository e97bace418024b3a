//! The drives that are documented, and what of a model each has room for. Effects and channels are limited by the image format itself.

use frikan_shared::pool::DRIVE_CELLS;

use super::host_model::CELLS;

/// A drive.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Profile {
    /// Its name, as `trainer verify --target` takes it.
    pub name: &'static str,
    /// Cells of tables for which it has room.
    pub cells: usize,
    /// Whether it calculates with floats by itself; else in integers, or by a library that takes its time.
    pub has_floats: bool,
}

/// The documented drives, the smallest first.
pub const PROFILES: [Profile; 7] = [
    Profile { name: "cortex-m0plus", cells: DRIVE_CELLS, has_floats: false },
    Profile { name: "riscv32imc", cells: DRIVE_CELLS, has_floats: false },
    Profile { name: "riscv32imac", cells: DRIVE_CELLS, has_floats: false },
    Profile { name: "cortex-m4f", cells: DRIVE_CELLS, has_floats: true },
    Profile { name: "cortex-m33", cells: DRIVE_CELLS, has_floats: true },
    Profile { name: "cortex-m7", cells: DRIVE_CELLS, has_floats: true },
    Profile { name: "host", cells: CELLS, has_floats: true },
];

impl Profile {
    /// The drive of a name.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        PROFILES.into_iter().find(|profile| profile.name == name)
    }
}

impl Default for Profile {
    /// The smallest.
    fn default() -> Self {
        PROFILES[0]
    }
}
