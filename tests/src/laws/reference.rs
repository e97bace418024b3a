//! The paper's law under the paper's noise: structures found, and whether the intervals hold the truth.

use frikan_trainer::law::{Discovery, SearchOptions, Shape, SignForm, Structure, discover};

use super::{joint, plain};
use crate::published::{JOINTS, NOISE, SAMPLES, SMOOTHING};

/// Constants of the law that can be identified under the paper's noise, with their true values for a joint.
#[must_use]
pub fn identifiable(k: [f64; 4]) -> [(&'static str, f64); 4] {
    [("coulomb_torque", k[0]), ("stribeck_extra_torque", k[1]), ("stribeck_velocity", k[2]), ("smoothing", SMOOTHING)]
}

/// The whole law, which clean samples determine.
#[must_use]
pub fn whole() -> Structure {
    plain(SignForm::Tanh, &[Shape::Sign, Shape::StribeckExponential, Shape::Viscous])
}

/// The law without its viscous term: the right answer under the paper's noise, since the Cramér-Rao bound of the viscous
/// coefficient (Fisher information of the five constants, 1000 samples) is 3 to 11 times the coefficient of every joint.
#[must_use]
pub fn dry() -> Structure {
    plain(SignForm::Tanh, &[Shape::Sign, Shape::StribeckExponential])
}

/// What became of one joint over many draws.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    /// Draws.
    pub draws: usize,
    /// Draws in which the right structure was found, its viscous term said not to be determined.
    pub right: usize,
    /// Of these, intervals that held the truth, in the order of [`identifiable`].
    pub inside: [usize; 4],
    /// The structures of the other draws.
    pub wrong: Vec<Structure>,
}

/// Discovery on one draw of joint `index` under its noise.
///
/// # Panics
/// When the samples cannot be used, which they can.
#[must_use]
pub fn noisy(index: usize, seed: u64) -> Discovery {
    discover(&joint(JOINTS[index], SAMPLES, NOISE[index] / 2.0, seed), &SearchOptions::default())
        .expect("usable samples")
}

/// Many draws of joint `index`, their seeds given.
#[must_use]
pub fn tally(index: usize, seeds: impl IntoIterator<Item = u64>) -> Tally {
    let mut tally = Tally::default();
    for seed in seeds {
        let found = noisy(index, seed);
        tally.draws += 1;
        let said = found.remarks.iter().any(|r| r.contains("viscous") && r.contains("determined"));
        if found.law.structure != dry() || !said {
            tally.wrong.push(found.law.structure);
            continue;
        }
        tally.right += 1;
        for (inside, (name, truth)) in tally.inside.iter_mut().zip(identifiable(JOINTS[index])) {
            let ci95 = found.law.parameters.iter().find(|p| p.name == name).map(|p| p.ci95);
            *inside += usize::from(ci95.is_some_and(|[low, high]| low <= truth && truth <= high));
        }
    }
    tally
}
