//! Ten laws other than the paper's, none of them special-cased by the search.

use std::f64::consts::FRAC_2_PI;

use frikan_trainer::kan::Random;
use frikan_trainer::law::{
    Channel, ChannelRole, Modulation, SearchOptions, Shape, SignForm, Structure, Term, discover,
};

use super::{channel, data, plain, velocity};
use crate::published::{SAMPLES, with_noise};

/// A generated law, its channels and the structures that are right answers.
#[derive(Clone, Debug)]
pub struct Case {
    /// What it is.
    pub name: &'static str,
    /// Its inputs.
    pub channels: Vec<Channel>,
    /// Its friction, N m.
    pub clean: Vec<f64>,
    /// Structures that say the same.
    pub right: Vec<Structure>,
}

impl Case {
    /// The structure found under noise of `share` times the range, where it is a wrong one.
    ///
    /// # Panics
    /// When the samples cannot be used, which they can.
    #[must_use]
    pub fn mistaken(self, share: f64, seed: u64) -> Option<Structure> {
        let target = with_noise(&self.clean, share, &mut Random::new(seed, 1));
        let found = discover(&data(self.channels, target), &SearchOptions::default()).expect("usable samples");
        (!self.right.contains(&found.law.structure)).then_some(found.law.structure)
    }
}

/// The ten laws on 1000 samples each; `seed` names the draw.
#[must_use]
pub fn cases(seed: u64) -> Vec<Case> {
    let mut random = Random::new(seed, 0);
    let mut column = |reach: f64| -> Vec<f64> { (0..SAMPLES).map(|_| random.uniform(-reach, reach)).collect() };
    let mut cases: Vec<Case> = of_velocity()
        .into_iter()
        .map(|(name, law, right)| {
            let v = column(2.0);
            Case { name, clean: v.iter().map(|v| law(*v)).collect(), channels: vec![velocity(v)], right }
        })
        .collect();
    let with = |structure: Structure, shape, modulation| structure.with(Term { shape, modulation });
    let coulomb_viscous = || plain(SignForm::Tanh, &[Shape::Sign, Shape::Viscous]);

    let (v, load) = (column(2.0), column(30.0));
    cases.push(Case {
        name: "load-dependent",
        clean: v.iter().zip(&load).map(|(v, l)| (4.0 + 0.2 * l.abs()) * (40.0 * v).tanh() + 3.0 * v).collect(),
        channels: vec![velocity(v), channel("load_torque", "N m", ChannelRole::Load, load)],
        right: vec![with(coulomb_viscous(), Shape::Sign, Modulation::Magnitude(1))],
    });
    let v = column(2.0);
    let t: Vec<f64> = column(20.0).into_iter().map(|t| 35.0 + t).collect();
    let decay = |t: f64| 5.0 * (-0.03 * (t - 25.0)).exp();
    cases.push(Case {
        name: "temperature",
        clean: v.iter().zip(&t).map(|(v, t)| 6.0 * (40.0 * v).tanh() + decay(*t) * v).collect(),
        channels: vec![velocity(v), channel("temperature", "°C", ChannelRole::Temperature, t)],
        right: vec![with(plain(SignForm::Tanh, &[Shape::Sign]), Shape::Viscous, Modulation::Decay(1))],
    });
    let (v, q) = (column(2.0), column(3.0));
    let ripple = |q: f64| 1.2 * (12.0 * q + 0.7).sin();
    cases.push(Case {
        name: "position ripple",
        clean: v.iter().zip(&q).map(|(v, q)| 6.0 * (40.0 * v).tanh() + 3.0 * v + ripple(*q)).collect(),
        channels: vec![velocity(v), channel("position", "rad", ChannelRole::Position, q)],
        right: vec![with(
            with(coulomb_viscous(), Shape::Offset, Modulation::Sine(1)),
            Shape::Offset,
            Modulation::Cosine(1),
        )],
    });
    cases
}

type OfVelocity = (&'static str, fn(f64) -> f64, Vec<Structure>);

fn of_velocity() -> Vec<OfVelocity> {
    use Shape::{
        AbsSign, AbsViscous, OddRoot, Offset, Quadratic, Sign, SignPower, StribeckExponential, StribeckGaussian,
        Viscous,
    };
    let tanh = |shapes: &[Shape]| plain(SignForm::Tanh, shapes);
    vec![
        (
            "Gaussian Stribeck",
            |v| (8.0 + 4.0 * (-(v / 0.3).powi(2)).exp()) * (40.0 * v).tanh() + 3.0 * v,
            vec![tanh(&[Sign, StribeckGaussian, Viscous])],
        ),
        (
            "asymmetric Coulomb-viscous",
            |v| {
                let (coulomb, viscous) = if v > 0.0 { (10.0, 4.0) } else { (7.0, 5.5) };
                coulomb * (60.0 * v).tanh() + viscous * v
            },
            vec![tanh(&[Sign, Viscous, AbsSign, AbsViscous]), tanh(&[Sign, Viscous, Offset, AbsViscous])],
        ),
        (
            "power-law viscosity",
            |v| 6.0 * (50.0 * v).tanh() + 5.0 * v.abs().powf(0.6) * v.signum(),
            vec![tanh(&[Sign, SignPower]), tanh(&[Sign, OddRoot])],
        ),
        (
            "arctangent Coulomb",
            |v| 9.0 * FRAC_2_PI * (30.0 * v).atan() + 2.0 * v,
            vec![plain(SignForm::Arctan, &[Sign, Viscous])],
        ),
        ("Bengisu-Akay", bengisu_akay, vec![plain(SignForm::Parabolic, &[Sign, StribeckExponential])]),
        (
            "Stribeck with quadratic drag",
            |v| (5.0 + 3.0 * (-(v / 0.2).abs()).exp()) * (50.0 * v).tanh() + 2.5 * v * v.abs(),
            vec![tanh(&[Sign, StribeckExponential, Quadratic])],
        ),
        (
            "algebraic Coulomb-viscous",
            |v| 7.0 * v / (v * v + 0.0025).sqrt() + 3.0 * v,
            vec![plain(SignForm::Algebraic, &[Sign, Viscous])],
        ),
    ]
}

/// Bengisu & Akay (1994): a parabola up to `v0`, an exponential decline beyond.
fn bengisu_akay(v: f64) -> f64 {
    let (v0, vs, coulomb, peak) = (0.08, 0.3, 8.0, 12.0);
    let speed = v.abs();
    let magnitude = if speed < v0 {
        peak - peak / (v0 * v0) * (speed - v0).powi(2)
    } else {
        coulomb + (peak - coulomb) * (-(speed - v0) / vs).exp()
    };
    v.signum() * magnitude
}
