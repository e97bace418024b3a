//! Does discovery find the law that generated the data? Short by default; `FRIKAN_EXHAUSTIVE=1` runs every seed.

use std::time::Instant;

use frikan_trainer::law::data::{Channel, ChannelRole, LawData};
use frikan_trainer::law::discover::{Discovery, SearchOptions, discover};
use frikan_trainer::law::known_forms::{KnownForm, fit_form};
use frikan_trainer::law::structure::{Modulation, Shape, SignForm, Structure, Term};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

/// Uniform and normal numbers from one seeded stream.
struct Random(ChaCha8Rng);

impl Random {
    fn new(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.0.next_u64() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Box & Muller (1958).
    fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform(0.0, 1.0)).ln()).sqrt();
        radius * (std::f64::consts::TAU * self.uniform(0.0, 1.0)).cos()
    }
}

fn exhaustive() -> bool {
    std::env::var("FRIKAN_EXHAUSTIVE").is_ok_and(|v| v == "1")
}

/// `[k1, k2, k3, k4]` of the six joints of the paper.
const JOINTS: [[f64; 4]; 6] = [
    [22.0, 8.0, 0.10, 0.03],
    [23.0, 10.0, 0.13, 0.16],
    [24.0, 12.0, 0.16, 0.29],
    [25.0, 14.0, 0.19, 0.42],
    [26.0, 16.0, 0.22, 0.55],
    [27.0, 18.0, 0.25, 0.68],
];

fn reference(k: [f64; 4], v: f64) -> f64 {
    (k[0] + k[1] * (-(v / k[2]).abs()).exp()) * (50.0 * v).tanh() + k[3] * v
}

fn uniform(random: &mut Random, n: usize, low: f64, high: f64) -> Vec<f64> {
    (0..n).map(|_| random.uniform(low, high)).collect()
}

fn velocity(values: Vec<f64>) -> Channel {
    Channel { name: "velocity".into(), unit: "rad/s".into(), role: ChannelRole::Velocity, values }
}

/// Adds noise of `share` times the range of the target.
fn data(channels: Vec<Channel>, clean: Vec<f64>, share: f64, random: &mut Random) -> LawData {
    let range =
        clean.iter().copied().fold(f64::NEG_INFINITY, f64::max) - clean.iter().copied().fold(f64::INFINITY, f64::min);
    let target: Vec<f64> = clean.iter().map(|y| y + share * range * random.normal()).collect();
    let blocks = (0..target.len()).map(|i| i * 10 / target.len()).collect();
    LawData { channels, target, target_unit: "N m".into(), nuisance: Vec::new(), blocks }
}

fn joint(k: [f64; 4], n: usize, share: f64, seed: u64) -> LawData {
    let mut random = Random::new(seed);
    let v = uniform(&mut random, n, -1.0, 1.0);
    let clean = v.iter().map(|v| reference(k, *v)).collect();
    data(vec![velocity(v)], clean, share, &mut random)
}

fn plain(sign: SignForm, shapes: &[Shape]) -> Structure {
    Structure::new(sign, shapes.iter().copied().map(Term::plain))
}

fn value(found: &Discovery, name: &str) -> Option<f64> {
    found.law.parameters.iter().find(|p| p.name == name).map(|p| p.value)
}

#[test]
fn clean_reference_law_is_found_exactly_for_every_joint() {
    let truth = plain(SignForm::Tanh, &[Shape::Sign, Shape::StribeckExponential, Shape::Viscous]);
    for (j, k) in JOINTS.into_iter().enumerate() {
        let start = Instant::now();
        let found = discover(&joint(k, 1000, 0.0, 7), &SearchOptions::default()).unwrap();
        let seconds = start.elapsed().as_secs_f64();
        println!(
            "joint {}: {} nodes, {} structures, {seconds:.2} s",
            j + 1,
            found.law.expression.node_count(),
            found.explored
        );
        assert_eq!(found.law.structure, truth, "joint {}: {:?}", j + 1, found.front);
        assert!(found.law.expression.node_count() <= 20);
        let names =
            ["coulomb_torque", "stribeck_extra_torque", "stribeck_velocity", "viscous_coefficient", "smoothing"];
        for (name, truth) in names.into_iter().zip([k[0], k[1], k[2], k[3], 50.0]) {
            let got = value(&found, name).unwrap();
            assert!((got / truth - 1.0).abs() < 1e-3, "{name} {got} {truth}");
        }
        assert!(seconds < 10.0);
    }
}
