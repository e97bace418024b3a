//! What a diagnosis is asked for, and why it may be refused.

use crate::diagnose::comparison::columns::BaseKind;
use crate::diagnose::preparation::rows::Lock;
use crate::diagnose::search::thresholds::Settings;

/// What a diagnosis is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Options {
    /// The base model.
    pub base: BaseKind,
    /// Which blocks are locked.
    pub lock: Lock,
    /// Limits of the search.
    pub settings: Settings,
}

impl Default for Options {
    fn default() -> Self {
        Self { base: BaseKind::CoulombViscous, lock: Lock::Spread, settings: Settings::default() }
    }
}

/// Why no diagnosis is possible.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Refusal {
    /// Too few rows of motion behind the filter.
    #[error("only {rows} rows of motion are left behind the filter at {cut_off_hz} Hz; at least {least} are needed")]
    TooLittleMotion {
        /// Rows that are left.
        rows: usize,
        /// Rows that are needed.
        least: usize,
        /// Cut-off of the filter in Hz.
        cut_off_hz: f64,
    },
    /// The torque is the same in every row.
    #[error("the torque is {torque} in every row: it was not measured")]
    NotMeasured {
        /// That torque.
        torque: f64,
    },
    /// The base model cannot be determined.
    #[error("the motion does not determine even the base model (one velocity, or no change of direction)")]
    Undetermined,
}
