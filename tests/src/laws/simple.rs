//! Data with little in them: noise alone, and Coulomb-viscous friction with two channels that do not matter.

use frikan_trainer::kan::Random;
use frikan_trainer::law::{ChannelRole, LawData, SearchOptions, Shape, SignForm, Structure, discover};

use super::{channel, data, plain, velocity};
use crate::published::with_noise;

/// What a set of samples was made from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Truth {
    /// Normal noise.
    Noise,
    /// `8 tanh(60 v) + 3 v` with normal noise of 5 % of its range.
    CoulombViscous,
}

/// 1000 samples of velocity, load and position, of which at most the velocity matters.
#[must_use]
pub fn samples(truth: Truth, seed: u64) -> LawData {
    let mut random = Random::new(seed, truth as u64);
    let mut column = |reach: f64| (0..1000).map(|_| random.uniform(-reach, reach)).collect::<Vec<f64>>();
    let (v, q, load) = (column(1.5), column(3.0), column(20.0));
    let target = match truth {
        Truth::Noise => (0..v.len()).map(|_| random.normal()).collect(),
        Truth::CoulombViscous => {
            let clean: Vec<f64> = v.iter().map(|v| 8.0 * (60.0 * v).tanh() + 3.0 * v).collect();
            with_noise(&clean, 0.05, &mut random)
        }
    };
    let load = channel("load_torque", "N m", ChannelRole::Load, load);
    data(vec![velocity(v), load, channel("position", "rad", ChannelRole::Position, q)], target)
}

/// The law that was found where it holds more than the truth does; for noise anything beyond Coulomb and viscous friction
/// counts, as in the plain sets.
///
/// # Panics
/// When the samples cannot be used, which they can.
#[must_use]
pub fn too_rich(truth: Truth, seed: u64) -> Option<Structure> {
    let found = discover(&samples(truth, seed), &SearchOptions::default()).expect("usable samples").law.structure;
    let enough = plain(SignForm::Tanh, &[Shape::Sign, Shape::Viscous]);
    (!found.terms().iter().all(|term| enough.has(*term))).then_some(found)
}
