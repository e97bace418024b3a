//! Multisines, whole or slowed down in parts, and an oscillation about a speed.

use super::{Grid, Trajectory};
use crate::second_opinion::numeric::{centre, integral, peak};
use crate::second_opinion::random::{Random, phase};
use std::f64::consts::TAU;

/// A sum of sines.
#[derive(Clone, Debug)]
pub struct Multisine {
    /// Angular frequency rad/s, amplitude of the position rad or m, phase rad.
    lines: Vec<[f64; 3]>,
}

impl Multisine {
    /// Lines at these frequencies (Hz) with these relative amplitudes of the position and phases of their own, at the speed
    /// and reach that it first meets on the grid.
    pub fn draw(lines: &[[f64; 2]], top_speed: f64, reach: f64, grid: &Grid, random: &mut Random) -> Self {
        let lines = lines.iter().map(|[hz, amplitude]| [TAU * hz, *amplitude, phase(random)]).collect();
        let mut sines = Self { lines };
        let relative = Trajectory::of(grid, |t| sines.state(t));
        let scale = (top_speed / peak(&relative.velocity)).min(reach / peak(&relative.position));
        sines.lines.iter_mut().for_each(|line| line[1] *= scale);
        sines
    }

    pub(super) fn state(&self, t: f64) -> [f64; 3] {
        let mut state = [0.0; 3];
        for [w, amplitude, phase] in &self.lines {
            let (sine, cosine) = (w * t + phase).sin_cos();
            state[0] += amplitude * sine;
            state[1] += amplitude * w * cosine;
            state[2] -= amplitude * w * w * sine;
        }
        state
    }
}

/// Slows a motion down in spans of the recording.
#[derive(Clone, Debug)]
pub struct Gate {
    /// Begin and end of each span, s.
    pub spans_s: Vec<(f64, f64)>,
    /// Share of the speed that is taken away.
    pub depth: f64,
}

impl Gate {
    /// Time of a change of speed, s.
    const CHANGE_S: f64 = 1.0;

    pub(super) fn slow_down(&self, t: f64, sines: &Multisine) -> [f64; 3] {
        let [mut warped, mut rate, mut change] = [t, 1.0, 0.0];
        for (begin, end) in &self.spans_s {
            for (edge, side) in [(begin, 1.0), (end, -1.0)] {
                let x = (t - edge) / Self::CHANGE_S;
                let half = 0.5 * self.depth * side;
                // ln cosh without overflow.
                warped -= half * Self::CHANGE_S * (x.abs() + (-2.0 * x.abs()).exp().ln_1p());
                rate -= half * x.tanh();
                change -= half * (1.0 - x.tanh().powi(2)) / Self::CHANGE_S;
            }
        }
        let [position, velocity, acceleration] = sines.state(warped);
        [position, velocity * rate, acceleration * rate * rate + velocity * change]
    }
}

/// A speed that oscillates without changing sign, but for a few reversals of the whole.
#[derive(Clone, Debug)]
pub struct Oscillation {
    /// rad/s or m/s.
    pub top_speed: f64,
    /// Duration of the recording, s.
    pub duration_s: f64,
    /// Phases of the reversals and of the two oscillations, rad.
    pub phases: [f64; 3],
}

impl Oscillation {
    /// Reversals are this sharp.
    const SHARPNESS: f64 = 8.0;

    fn speed(&self, t: f64) -> [f64; 2] {
        let [reversals, slow, fast] = self.phases;
        let whole = 2.0 * TAU / self.duration_s;
        let direction = (Self::SHARPNESS * (whole * t + reversals).sin()).tanh();
        let turning = (1.0 - direction * direction) * Self::SHARPNESS * whole * (whole * t + reversals).cos();
        let (w1, w2) = (TAU * 1.3, TAU * 3.7);
        let size = 0.5 + 0.25 * (w1 * t + slow).sin() + 0.22 * (w2 * t + fast).sin();
        let growth = 0.25 * w1 * (w1 * t + slow).cos() + 0.22 * w2 * (w2 * t + fast).cos();
        [self.top_speed * direction * size, self.top_speed * (turning * size + direction * growth)]
    }

    pub(super) fn at(&self, grid: &Grid) -> Trajectory {
        moved_by(grid, |t| self.speed(t))
    }
}

/// The trajectory of a velocity and its derivative, about zero.
pub(super) fn moved_by(grid: &Grid, speed: impl Fn(f64) -> [f64; 2]) -> Trajectory {
    let mut path = Trajectory::of(grid, |t| {
        let [velocity, acceleration] = speed(t);
        [0.0, velocity, acceleration]
    });
    path.position = integral(&path.velocity, &path.acceleration, grid.period_s);
    centre(&mut path.position);
    path
}
