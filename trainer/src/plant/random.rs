//! Seeded random numbers: one independent stream a purpose, so that hiding an effect leaves the noise as it was.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};
use std::f64::consts::TAU;

/// What a stream of random numbers is used for.
#[derive(Clone, Copy)]
pub(crate) enum Purpose {
    Motion = 1,
    Noise = 2,
    Channels = 3,
    /// The n-th hidden effect takes `Effect + n`.
    Effect = 100,
}

/// Uniform and normal numbers of one stream, with a log of every named draw.
pub(crate) struct Draws {
    rng: ChaCha8Rng,
    spare: Option<f64>,
    log: Vec<(String, f64)>,
}

impl Draws {
    pub(crate) fn new(seed: u64, purpose: Purpose, index: u64) -> Self {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        rng.set_stream(purpose as u64 + index);
        Self { rng, spare: None, log: Vec::new() }
    }

    /// Uniform on [0, 1), 53 bits.
    pub(crate) fn unit(&mut self) -> f64 {
        (self.rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    pub(crate) fn index(&mut self, count: usize) -> usize {
        ((self.unit() * count as f64) as usize).min(count - 1)
    }

    pub(crate) fn sign(&mut self) -> f64 {
        if self.unit() < 0.5 { -1.0 } else { 1.0 }
    }

    /// Standard normal (Box & Muller 1958).
    pub(crate) fn normal(&mut self) -> f64 {
        if let Some(value) = self.spare.take() {
            return value;
        }
        let radius = (-2.0 * (1.0 - self.unit()).ln()).sqrt();
        let angle = TAU * self.unit();
        self.spare = Some(radius * angle.sin());
        radius * angle.cos()
    }

    /// A named parameter, uniform.
    pub(crate) fn uniform(&mut self, name: &str, low: f64, high: f64) -> f64 {
        let value = self.between(low, high);
        self.note(name, value)
    }

    /// A named parameter, uniform in its logarithm.
    pub(crate) fn log_uniform(&mut self, name: &str, low: f64, high: f64) -> f64 {
        let value = self.between(low.ln(), high.ln()).exp();
        self.note(name, value)
    }

    /// A named parameter, uniform in magnitude with a random sign.
    pub(crate) fn signed(&mut self, name: &str, low: f64, high: f64) -> f64 {
        let value = self.sign() * self.between(low, high);
        self.note(name, value)
    }

    /// A named choice, uniform over `0..count`.
    pub(crate) fn choice(&mut self, name: &str, count: usize) -> usize {
        let value = self.index(count);
        self.note(name, value as f64);
        value
    }

    pub(crate) fn note(&mut self, name: &str, value: f64) -> f64 {
        self.log.push((name.to_owned(), value));
        value
    }

    /// Every named parameter in the order it was drawn.
    pub(crate) fn into_log(self) -> Vec<(String, f64)> {
        self.log
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_are_independent_and_repeatable() {
        let take = |index| {
            let mut draws = Draws::new(7, Purpose::Effect, index);
            (0..8).map(|_| draws.unit()).collect::<Vec<_>>()
        };
        assert_eq!(take(0), take(0));
        assert_ne!(take(0), take(1));
    }

    #[test]
    fn normal_has_unit_variance() {
        let mut draws = Draws::new(3, Purpose::Noise, 0);
        let values: Vec<f64> = (0..20_000).map(|_| draws.normal()).collect();
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        let variance = values.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / values.len() as f64;
        assert!(mean.abs() < 0.03 && (variance - 1.0).abs() < 0.04, "mean {mean}, variance {variance}");
    }
}
