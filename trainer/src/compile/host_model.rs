//! A model as the trainer holds it.

use frikan_shared::model::Model;

/// Cells for which the trainer has room; more than any drive.
pub const CELLS: usize = 4096;

/// A model as the trainer holds it.
pub type HostModel = Model<CELLS>;
