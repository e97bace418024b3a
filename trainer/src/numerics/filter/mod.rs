//! The zero-phase low-pass filters, applied alike to every channel of a recording, and how a signal goes on beyond its ends.
//!
//! There are two, because `fit` and `diagnose` ask for different things. A [`gaussian`] has the velocity and the acceleration as
//! convolutions with its own derivatives and no side lobes: a stick-slip edge does not ring through the learned curve. Its
//! transition is slow. A `windowed_sinc` keeps the shape of what is below the cut-off, so that an effect of known frequency
//! (gear teeth, an impact, a delay) keeps its amplitude and the noise above it is gone.

pub mod gaussian;
pub(crate) mod windowed_sinc;

use std::ops::Range;

/// A signal with `half` samples more at each end, by point reflection about the end sample, which keeps level and slope.
/// Nothing stays nothing.
pub(crate) fn continued(signal: &[f64], half: usize) -> Vec<f64> {
    Part::all(signal).continued(&(0..signal.len()), half)
}

/// A part of a signal, so that a long one is filtered part by part.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part<'a> {
    values: &'a [f64],
    /// Place of the first of them in the signal.
    begin: usize,
    /// Length of the signal.
    whole: usize,
}

impl<'a> Part<'a> {
    /// The values from `begin` on of a signal of length `whole`.
    pub(crate) fn of(values: &'a [f64], begin: usize, whole: usize) -> Self {
        Self { values, begin, whole }
    }

    /// All of a signal.
    pub(crate) fn all(signal: &'a [f64]) -> Self {
        Self::of(signal, 0, signal.len())
    }

    /// Length of the signal.
    pub(crate) fn whole(&self) -> usize {
        self.whole
    }

    /// The values at `wanted` and at `half` places before and behind, where the signal ends as [`continued`]; the part holds what of them the signal
    /// has.
    fn continued(&self, wanted: &Range<usize>, half: usize) -> Vec<f64> {
        let Some(last) = self.whole.checked_sub(1) else { return Vec::new() };
        let at = |place: usize| self.values[place - self.begin];
        let before = (1..=half.saturating_sub(wanted.start)).rev().map(|k| 2.0 * at(0) - at(k.min(last)));
        let inner = wanted.start.saturating_sub(half)..(wanted.end + half).min(self.whole);
        let beyond = (wanted.end + half).saturating_sub(self.whole);
        let after = (1..=beyond).map(|k| 2.0 * at(last) - at(last - k.min(last)));
        let inner = &self.values[inner.start - self.begin..inner.end - self.begin];
        before.chain(inner.iter().copied()).chain(after).collect()
    }
}
