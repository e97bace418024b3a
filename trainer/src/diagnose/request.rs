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
    /// Share (0..1) of the torque beside the rigid body, root mean square, below which a finding is listed but not acted on. `None`:
    /// 2 % for the friction level of a reference; for all else as much where the noise hides it, and less where
    /// it does not.
    pub least_effect: Option<f64>,
    /// Whether sets of effects are weighed by one likelihood, in place of the search by scores.
    pub by_likelihood: bool,
    /// Whether the recording was found to be wrong as a measurement: then no physics is looked for.
    pub measured_wrong: bool,
}

/// Share (0..1) of the torque beside the rigid body (root mean squares), below which an effect is not acted on unless
/// the recording shows it far above its noise: a joint's own friction drifts by as much from one day to the next
/// (Bittencourt and Gunnarsson 2012).
pub const LEAST_EFFECT_SHARE: f64 = 0.02;

impl Default for Options {
    fn default() -> Self {
        Self {
            base: BaseKind::CoulombViscous,
            lock: Lock::Spread,
            settings: Settings::default(),
            least_effect: None,
            by_likelihood: false,
            measured_wrong: false,
        }
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
