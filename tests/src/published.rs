//! The friction law, noise and samples of the paper's simulated experiments (Wang, Rabczuk & Liu, six joints).

use frikan_trainer::kan::Random;

/// `[k1, k2, k3, k4]` of the six joints: Coulomb and Stribeck extra torque N m, Stribeck velocity rad/s, viscous
/// coefficient N m s/rad.
pub const JOINTS: [[f64; 4]; 6] = [
    [22.0, 8.0, 0.10, 0.03],
    [23.0, 10.0, 0.13, 0.16],
    [24.0, 12.0, 0.16, 0.29],
    [25.0, 14.0, 0.19, 0.42],
    [26.0, 16.0, 0.22, 0.55],
    [27.0, 18.0, 0.25, 0.68],
];

/// Slope of the smoothed sign, s/rad.
pub const SMOOTHING: f64 = 50.0;

/// Noise `λ` of the six joints; the standard deviation is `λ/2` of the range of friction.
pub const NOISE: [f64; 6] = [0.03, 0.05, 0.08, 0.12, 0.15, 0.20];

/// Samples of each joint.
pub const SAMPLES: usize = 1000;

/// Friction torque at velocity `v` (rad/s), N m.
#[must_use]
pub fn friction([coulomb, extra, stribeck, viscous]: [f64; 4], v: f64) -> f64 {
    (coulomb + extra * (-(v / stribeck).abs()).exp()) * (SMOOTHING * v).tanh() + viscous * v
}

/// Recorded or simulated velocities, rad/s, with the friction at each, N m.
#[derive(Clone, Debug)]
pub struct Samples {
    /// Uniform in `[-1, 1]`.
    pub velocity: Vec<f64>,
    /// Without noise.
    pub clean: Vec<f64>,
    /// With noise.
    pub noisy: Vec<f64>,
}

/// `n` samples of one joint with normal noise of `share` times the range of the clean samples.
#[must_use]
pub fn samples(k: [f64; 4], n: usize, share: f64, random: &mut Random) -> Samples {
    let velocity: Vec<f64> = (0..n).map(|_| random.uniform(-1.0, 1.0)).collect();
    let clean: Vec<f64> = velocity.iter().map(|v| friction(k, *v)).collect();
    let noisy = with_noise(&clean, share, random);
    Samples { velocity, clean, noisy }
}

/// Normal noise of `share` times the range of `clean` added to it.
#[must_use]
pub fn with_noise(clean: &[f64], share: f64, random: &mut Random) -> Vec<f64> {
    let high = clean.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let low = clean.iter().copied().fold(f64::INFINITY, f64::min);
    clean.iter().map(|y| y + share * (high - low) * random.normal()).collect()
}
