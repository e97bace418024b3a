//! A column on its way to be taken for a quantity.

use crate::recording::quantity::{Quantity, Unit};
use crate::recording::table::RawTable;

/// Rows from which units are told.
const ROWS_LOOKED_AT: usize = 100_000;

/// What stands for the torque of the actuator where it is recorded.
const MEASURED: [Quantity; 5] =
    [Quantity::Torque, Quantity::Force, Quantity::Current, Quantity::FrictionTorque, Quantity::FrictionForce];

/// A column and what it is taken for.
pub(super) struct Candidate {
    pub(super) index: usize,
    pub(super) quantity: Quantity,
    pub(super) unit: Option<&'static Unit>,
    pub(super) scale: f64,
    /// Whether the name alone is read as this, without an entry under `[columns]`.
    pub(super) by_itself: bool,
    pub(super) why: String,
}

/// Whether one of `wanted` was found.
pub(super) fn has(found: &[Candidate], wanted: &[Quantity]) -> bool {
    found.iter().any(|candidate| wanted.contains(&candidate.quantity))
}

/// Whether torque, force, current or friction was found.
pub(super) fn is_measured(found: &[Candidate]) -> bool {
    has(found, &MEASURED)
}

/// The numbers of a column, not finite where there is none.
pub(super) fn numbers(raw: &RawTable, column: usize) -> Vec<f64> {
    raw.numbers[column].values.iter().take(ROWS_LOOKED_AT).copied().collect()
}

/// Lowest and highest of what is finite; `None` where nothing is.
pub(super) fn range(values: &[f64]) -> Option<[f64; 2]> {
    let finite = values.iter().copied().filter(|value| value.is_finite());
    finite.fold(None, |range, value| match range {
        None => Some([value; 2]),
        Some([low, high]) => Some([value.min(low), value.max(high)]),
    })
}
