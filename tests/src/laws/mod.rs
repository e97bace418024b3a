//! Data of which the law is known, and how often discovery finds it.

pub mod other;
pub mod reference;
pub mod simple;

use frikan_trainer::law::{Channel, ChannelRole, LawData, Shape, SignForm, Structure, Term};

use crate::published::samples;

/// Parts into which the samples are cut for holding out.
const BLOCKS: usize = 10;

/// Samples in the order given, in ten blocks.
#[must_use]
pub fn data(channels: Vec<Channel>, target: Vec<f64>) -> LawData {
    let blocks = (0..target.len()).map(|i| i * BLOCKS / target.len()).collect();
    LawData { channels, target, target_unit: "N m".into(), nuisance: Vec::new(), states: None, blocks }
}

/// A channel of velocities, rad/s.
#[must_use]
pub fn velocity(values: Vec<f64>) -> Channel {
    channel("velocity", "rad/s", ChannelRole::Velocity, values)
}

/// Any other channel.
#[must_use]
pub fn channel(name: &str, unit: &str, role: ChannelRole, values: Vec<f64>) -> Channel {
    Channel { name: name.into(), unit: unit.into(), role, values }
}

/// A law of velocity alone.
#[must_use]
pub fn plain(sign: SignForm, shapes: &[Shape]) -> Structure {
    Structure::new(sign, shapes.iter().copied().map(Term::plain))
}

/// Samples of one of the paper's joints, noise as a share of the range; `seed` names the draw.
#[must_use]
pub fn joint(k: [f64; 4], n: usize, share: f64, seed: u64) -> LawData {
    let samples = samples(k, n, share, &mut frikan_trainer::kan::Random::new(seed, 0));
    data(vec![velocity(samples.velocity)], samples.noisy)
}
