//! The slow and foreign channels of a recording: temperature of the housing and the neighbouring joint.

use crate::plant::joint::{OtherJoint, Thermal};
use crate::plant::random::{Draws, Purpose};
use std::f64::consts::TAU;

/// Temperature of the housing, first order.
pub(crate) struct Housing {
    thermal: Thermal,
    pub(crate) temperature: f64,
}

impl Housing {
    pub(crate) fn new(thermal: &Thermal) -> Self {
        Self { thermal: thermal.clone(), temperature: thermal.ambient_c }
    }

    /// Exact step under constant dissipated `power`, W.
    pub(crate) fn advance(&mut self, power: f64, step_s: f64) {
        let settled = self.thermal.ambient_c + self.thermal.idle_rise_k + self.thermal.rise_k_w * power;
        self.temperature += (settled - self.temperature) * -(-step_s / self.thermal.time_constant_s).exp_m1();
    }
}

/// State of the neighbouring joint.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Neighbour {
    pub(crate) position: f64,
    pub(crate) velocity: f64,
    pub(crate) acceleration: f64,
}

impl Neighbour {
    /// The state a moment later, by its Taylor series.
    pub(crate) fn after(self, time: f64) -> Self {
        Self {
            position: self.position + (self.velocity + 0.5 * self.acceleration * time) * time,
            velocity: self.velocity + self.acceleration * time,
            ..self
        }
    }
}

/// The neighbouring joint follows a multisine of its own that has no frequency in common with this joint's motions.
pub(crate) struct NeighbourMotion {
    tones: Vec<(f64, f64, f64)>,
}

impl NeighbourMotion {
    pub(crate) fn new(config: &OtherJoint, seed: u64) -> Self {
        if !config.recorded {
            return Self { tones: Vec::new() };
        }
        let mut draws = Draws::new(seed, Purpose::Channels, 0);
        let count = 5;
        let tones = (0..count)
            .map(|i| {
                let frequency =
                    config.highest_hz * 0.1_f64.powf(1.0 - (i as f64 + draws.between(0.1, 0.9)) / count as f64);
                let size = config.amplitude_rad * 0.1 * config.highest_hz / frequency;
                (TAU * frequency, size, draws.between(0.0, TAU))
            })
            .collect();
        Self { tones }
    }

    pub(crate) fn at(&self, time: f64) -> Neighbour {
        self.tones.iter().fold(Neighbour::default(), |sum, &(omega, size, phase)| {
            let (sine, cosine) = (omega * time + phase).sin_cos();
            Neighbour {
                position: sum.position + size * sine,
                velocity: sum.velocity + size * omega * cosine,
                acceleration: sum.acceleration - size * omega * omega * sine,
            }
        })
    }
}
