//! What keeps a joint from being simulated.

use crate::error::{Error, codes};

/// Most samples of a simulation: an hour at 5 kHz, 3 GB of signals.
pub const MOST_SAMPLES: f64 = 1.8e7;

/// What keeps a joint from being simulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlantError {
    /// No effect has this name.
    #[error("no effect is called `{0}`; see docs/simulate.md for the names")]
    UnknownEffect(String),
    /// A value is outside its range.
    #[error("`{key}` must be {range}, not {value}")]
    OutOfRange {
        /// Key in the `[plant]` section.
        key: &'static str,
        /// Its range in words.
        range: &'static str,
        /// The value found.
        value: f64,
    },
    /// The recording would be longer than memory should hold.
    #[error(
        "{0:e} samples are more than the {MOST_SAMPLES:e} that a simulation has at most; lower the length or `drive.rate_Hz`"
    )]
    TooLong(f64),
    /// Two hidden effects each need a transmission of their own.
    #[error("`{0}` cannot be combined with another compliant or inexact transmission")]
    TwoTransmissions(String),
    /// The motion left all bounds: the effects are too strong for the controller.
    #[error("the joint became unstable {0} s into the recording; lower the amplitudes")]
    Unstable(f64),
}

impl From<PlantError> for Error {
    /// `FRK-U001` for effects that do not exist or exclude each other, `FRK-D015` for all else: the description of the joint.
    fn from(error: PlantError) -> Self {
        let code = match error {
            PlantError::UnknownEffect(_) | PlantError::TwoTransmissions(_) => &codes::USAGE,
            PlantError::OutOfRange { .. } | PlantError::TooLong(_) | PlantError::Unstable(_) => &codes::BAD_JOINT_FILE,
        };
        Self::new(code, error.to_string())
    }
}
