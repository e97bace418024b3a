//! A note on the measurement chain.

use crate::physics::EffectId;
use serde::Serialize;

/// A note on the measurement chain.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct HealthNote {
    /// The effect of the catalogue it stands for.
    pub effect: EffectId,
    /// Whether a diagnosis of physics makes no sense before it is repaired.
    pub blocking: bool,
    /// One sentence with figures.
    pub sentence: String,
}
