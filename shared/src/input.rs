//! An input channel of a model, and how many there can be.

#[cfg(feature = "models")]
use serde::{Deserialize, Serialize};

#[cfg(feature = "models")]
use crate::units::{Quantity, Unit};

/// Most inputs of a model; a power of two, so that an input index is a mask.
pub const MAX_INPUTS: usize = 4;

/// An input channel. Outside `[low, high]` the model holds the value that it has at the nearer end.
#[cfg(feature = "models")]
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Input {
    /// What it measures.
    pub quantity: Quantity,
    /// Its unit.
    pub unit: Unit,
    /// Smallest trained value, finite.
    pub low: f32,
    /// Largest trained value, finite, above `low`.
    pub high: f32,
}
