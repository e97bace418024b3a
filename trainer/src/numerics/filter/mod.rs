//! The zero-phase low-pass filters, applied alike to every channel of a recording, and how a signal goes on beyond its ends.
//!
//! There are two, because `fit` and `diagnose` ask for different things. A [`gaussian`] has the velocity and the acceleration as
//! convolutions with its own derivatives and no side lobes: a stick-slip edge does not ring through the learned curve. Its
//! transition is slow. A `windowed_sinc` keeps the shape of what is below the cut-off, so that an effect of known frequency
//! (gear teeth, an impact, a delay) keeps its amplitude and the noise above it is gone.

pub mod gaussian;
pub(crate) mod windowed_sinc;

/// A signal with `half` samples more at each end, by point reflection about the end sample, which keeps level and slope.
/// Nothing stays nothing.
pub(crate) fn continued(signal: &[f64], half: usize) -> Vec<f64> {
    let (Some(&head), Some(&tail)) = (signal.first(), signal.last()) else { return Vec::new() };
    let last = signal.len() - 1;
    let before = (1..=half).rev().map(|k| 2.0 * head - signal[k.min(last)]);
    let after = (1..=half).map(|k| 2.0 * tail - signal[last - k.min(last)]);
    before.chain(signal.iter().copied()).chain(after).collect()
}
