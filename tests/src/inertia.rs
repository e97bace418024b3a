//! Inertia of simulated joints whose encoder, sample rate and torque noise vary: how far off it is, and whether its interval holds
//! the truth.

use std::f64::consts::TAU;
use std::fmt::Write;

use frikan_trainer::fit::outcome::Representation;
use frikan_trainer::fit::{Options, Training, fit};
use frikan_trainer::joint::Joint;
use frikan_trainer::kan::Random;
use frikan_trainer::recording;

/// Bits of one turn of the encoder.
pub const BITS: [u32; 4] = [10, 13, 16, 20];
/// Samples a second, Hz.
pub const RATES: [f64; 4] = [100.0, 500.0, 1000.0, 5000.0];
/// Standard deviation of the torque's noise, as a share of the root mean square of the torque.
pub const NOISE: [f64; 4] = [0.005, 0.02, 0.07, 0.2];
/// Length of a recording, s.
const SECONDS: f64 = 20.0;
/// An inertia within this share of the truth is right whatever its interval.
const CLOSE: f64 = 0.05;

/// How a recording is measured.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    /// Bits of one turn of the encoder.
    pub bits: u32,
    /// Samples a second, Hz.
    pub rate_hz: f64,
    /// Noise of the torque, share of its root mean square.
    pub noise: f64,
}

/// The inertia that was found.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// Its error as a share of the truth.
    pub error: f64,
    /// Whether its 95 % interval holds the truth.
    pub inside: bool,
}

impl Found {
    /// Close to the truth, or with an interval that holds it.
    #[must_use]
    pub fn is_right(self) -> bool {
        self.inside || self.error.abs() <= CLOSE
    }
}

/// A joint that swings at three frequencies, with gravity, Coulomb and viscous friction; its inertia in kg m2 and its recording.
#[must_use]
pub fn simulated(setting: Setting, seed: u64) -> (f64, String) {
    let mut draw = Random::new(seed, 0);
    let waves: [[f64; 3]; 3] = [[0.7, 1.1, 0.15], [0.35, 0.6, 0.55], [0.1, 0.2, 1.5]]
        .map(|[low, high, hz]| [draw.uniform(low, high), TAU * hz * draw.uniform(0.6, 1.0), draw.uniform(0.0, TAU)]);
    let (inertia, gravity) = (draw.uniform(0.03, 0.2), draw.uniform(0.5, 2.5));
    let (coulomb, viscous) = (draw.uniform(0.2, 1.0), draw.uniform(0.1, 0.4));
    let step = TAU / 2f64.powi(setting.bits as i32);
    let zero = draw.uniform(0.0, step);
    let rows = (SECONDS * setting.rate_hz) as usize;
    let mut motion = Vec::with_capacity(rows);
    for row in 0..rows {
        let t = row as f64 / setting.rate_hz;
        let sum = |f: &dyn Fn([f64; 3]) -> f64| waves.iter().map(|wave| f(*wave)).sum::<f64>();
        let position = sum(&|[a, w, p]| a * (w * t + p).sin());
        let velocity = sum(&|[a, w, p]| a * w * (w * t + p).cos());
        let acceleration = sum(&|[a, w, p]| -a * w * w * (w * t + p).sin());
        let friction = coulomb * (velocity / 0.003).tanh() + viscous * velocity;
        motion.push((t, position, inertia * acceleration + gravity * position.sin() + friction));
    }
    let rms = (motion.iter().map(|(_, _, torque)| torque * torque).sum::<f64>() / rows as f64).sqrt();
    let mut text = String::from("time_s,position_rad,torque_Nm\n");
    for (t, position, torque) in motion {
        let read = ((position + zero) / step).floor() * step;
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{t:.6},{read:.9},{:.6}", torque + setting.noise * rms * draw.normal());
    }
    (inertia, text)
}

/// Fits a simulated recording and compares the inertia.
///
/// # Errors
/// Whatever reading or fitting refuses.
pub fn found(setting: Setting, seed: u64) -> frikan_trainer::error::Result<Found> {
    let (truth, text) = simulated(setting, seed);
    let joint = Joint::default();
    let recording = recording::parse("simulated.csv", text.as_bytes(), &joint)?;
    let training = Training { restarts: Some(1), steps: Some(20), refinements: Some(0), ..Training::default() };
    let options = Options { seed: 1, representation: Some(Representation::Expression), training, ..Options::default() };
    let outcome = fit(&[recording], &[], &joint, &options, &|_| ())?;
    let inertia = outcome.parameters.iter().find(|parameter| parameter.name == "inertia");
    Ok(inertia.map_or(Found { error: -1.0, inside: false }, |found| Found {
        error: found.value / truth - 1.0,
        inside: found.ci95[0] <= truth && truth <= found.ci95[1],
    }))
}
