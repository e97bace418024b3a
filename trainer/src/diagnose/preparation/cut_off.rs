//! The choice of the common filter: as wide as the errors of the position allow.

use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::commanded_noise::commanded_noise;
use crate::diagnose::preparation::position_error::{encoder_noise_is_small, noise_biases};
use crate::diagnose::preparation::rows::Lock;
use crate::diagnose::preparation::states::{Known, Prepared};
use crate::physics::JointState;

/// Cut-off frequencies that are tried, widest first, Hz. Chosen by judgement: each about three quarters of the one
/// before, so that the grid costs at most a quarter of the band; a first one beyond 50 Hz costs rows and computing
/// time.
const CUT_OFFS_HZ: [f64; 11] = [50.0, 40.0, 30.0, 22.0, 16.0, 12.0, 9.0, 6.5, 4.5, 3.0, 2.0];

/// Largest cut-off over the rate of the samples.
const LARGEST_RATE_SHARE: f64 = 0.11;

/// The widest filter that is tried at a rate of so many samples a second: its cut-off, Hz.
pub(crate) fn widest_cut_off_hz(rate_hz: f64) -> f64 {
    CUT_OFFS_HZ.into_iter().find(|hz| *hz <= LARGEST_RATE_SHARE * rate_hz).unwrap_or(LARGEST_RATE_SHARE * rate_hz)
}

impl Prepared {
    /// Prepares states and rows. The cut-off is the widest at which the errors of the position, through the inertia, stay
    /// small against the residual.
    pub fn new(signals: &Signals, known: Known, lock: Lock) -> Self {
        let rate = 1.0 / signals.period;
        let mut chosen = None;
        let noise = commanded_noise(signals);
        for cut_off in CUT_OFFS_HZ.into_iter().filter(|hz| *hz <= LARGEST_RATE_SHARE * rate) {
            let mut prepared = Self::under_noise(signals, cut_off, noise, known, lock);
            prepared.quantisation_limited = chosen.is_some();
            let fits = encoder_noise_is_small(&prepared, signals) && !noise_biases(&prepared, noise);
            let enough_rows = prepared.rows.len() >= 200;
            match chosen {
                // A narrower filter that leaves too little to work on is no help.
                Some(wider) if !enough_rows => return Self { quantisation_limited: true, ..wider },
                _ if fits => return prepared,
                _ => chosen = Some(prepared),
            }
        }
        chosen.unwrap_or_else(|| Self::under_noise(signals, LARGEST_RATE_SHARE * rate, noise, known, lock))
    }
}

impl Signals {
    /// The states behind the filter that the recording asks for.
    #[must_use]
    pub fn states(&self) -> JointState {
        Prepared::new(self, Known::of(self), Lock::Nothing).state
    }
}
