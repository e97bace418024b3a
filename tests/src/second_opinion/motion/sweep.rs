//! Rising frequencies.

use super::harmonic::moved_by;
use super::{Grid, Trajectory};
use crate::second_opinion::numeric::{gradient, smooth_step};
use std::f64::consts::TAU;

/// Phase (rad) and frequency (rad/s) of a sine whose frequency rises by the same factor every second.
fn rising(from_hz: f64, to_hz: f64, duration_s: f64, t: f64) -> [f64; 2] {
    let growth = (to_hz / from_hz).ln() / duration_s;
    let frequency = TAU * from_hz * (growth * t).exp();
    [(frequency - TAU * from_hz) / growth, frequency]
}

/// A sine of the velocity with a rising frequency, at a speed that swells and ebbs.
#[derive(Clone, Debug)]
pub struct Chirp {
    /// First and last frequency, Hz.
    pub hz: [f64; 2],
    /// rad/s or m/s.
    pub top_speed: f64,
    /// Duration of the recording, s.
    pub duration_s: f64,
    /// Phases of the sine and of the swell, rad.
    pub phases: [f64; 2],
}

impl Chirp {
    /// Swells of a recording.
    const SWELLS: f64 = 3.3;

    pub(super) fn at(&self, grid: &Grid) -> Trajectory {
        let swell = TAU * Self::SWELLS / self.duration_s;
        moved_by(grid, |t| {
            let [angle, frequency] = rising(self.hz[0], self.hz[1], self.duration_s, t);
            let (sine, cosine) = (angle + self.phases[0]).sin_cos();
            let size = 0.55 + 0.45 * (swell * t + self.phases[1]).cos();
            let growth = -0.45 * swell * (swell * t + self.phases[1]).sin();
            [self.top_speed * size * sine, self.top_speed * (growth * sine + size * frequency * cosine)]
        })
    }
}

/// A sine of the position with a rising frequency, as wide as reach and speed allow.
#[derive(Clone, Debug)]
pub struct Sweep {
    /// First and last frequency, Hz.
    pub hz: [f64; 2],
    /// rad/s or m/s.
    pub top_speed: f64,
    /// rad or m.
    pub reach: f64,
    /// Duration of the recording, s.
    pub duration_s: f64,
}

impl Sweep {
    /// How sharply the bound of reach gives way to that of speed.
    const SHARPNESS: i32 = 8;
    /// Time until it is as wide as it may be, s.
    const FADE_IN_S: f64 = 1.0;

    pub(super) fn at(&self, grid: &Grid) -> Trajectory {
        let position = |t: f64| {
            let [angle, frequency] = rising(self.hz[0], self.hz[1], self.duration_s, t);
            let both = self.reach.powi(-Self::SHARPNESS) + (frequency / self.top_speed).powi(Self::SHARPNESS);
            both.powf(-1.0 / f64::from(Self::SHARPNESS)) * smooth_step(t / Self::FADE_IN_S) * angle.sin()
        };
        let time = grid.times();
        let position: Vec<f64> = time.iter().map(|t| position(*t)).collect();
        let velocity = gradient(&position, grid.period_s);
        let acceleration = gradient(&velocity, grid.period_s);
        Trajectory { time, position, velocity, acceleration }
    }
}
