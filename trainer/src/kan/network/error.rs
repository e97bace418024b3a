//! What can be wrong with the request for a network or a fit.

use thiserror::Error;

/// Why a network cannot be built or trained.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum KanError {
    /// A spline grid has an unsupported order, no cell, or breaks that do not increase.
    #[error("a spline grid of order {order} with {cells} cells is not possible here")]
    Grid {
        /// Polynomial order asked for.
        order: usize,
        /// Number of cells asked for.
        cells: usize,
    },
    /// The text is not an architecture such as `[1,[5,2],1]`.
    #[error("`{text}` is not an architecture such as [1,5,1] or [2,[5,2],1]: {reason}")]
    Architecture {
        /// What was given.
        text: String,
        /// What is wrong with it.
        reason: &'static str,
    },
    /// Columns differ in length, or their number differs from the architecture's.
    #[error("{what}: expected {expected}, found {found}")]
    Shape {
        /// Which count disagrees.
        what: &'static str,
        /// The count required.
        expected: usize,
        /// The count given.
        found: usize,
    },
    /// A value is NaN or infinite.
    #[error("row {row} of {column} is not finite")]
    NotFinite {
        /// Which column.
        column: String,
        /// Zero-based row.
        row: usize,
    },
    /// There is nothing to learn from.
    #[error("{found} training rows are too few, at least {needed} are needed")]
    TooFewRows {
        /// Rows in the training blocks.
        found: usize,
        /// Rows needed.
        needed: usize,
    },
}
