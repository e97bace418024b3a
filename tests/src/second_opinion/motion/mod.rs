//! Motions that are prescribed: position, velocity and acceleration of one formula, at any rate.

mod harmonic;
mod plan;
mod slow;
mod strokes;
mod sweep;

pub use harmonic::{Gate, Multisine, Oscillation};
pub use plan::{CHIRP, MULTISINE, Plan, STROKES};
pub use slow::SlowSines;
pub use strokes::Strokes;
pub use sweep::{Chirp, Sweep};

/// Uniform instants from zero on.
#[derive(Clone, Copy, Debug)]
pub struct Grid {
    /// Time between two instants, s.
    pub period_s: f64,
    /// How many there are.
    pub samples: usize,
}

impl Grid {
    /// `samples` instants at a rate.
    #[must_use]
    pub fn new(rate_hz: f64, samples: usize) -> Self {
        Self { period_s: 1.0 / rate_hz, samples }
    }

    /// The same instants with `parts - 1` more between two of them.
    #[must_use]
    pub fn refined(&self, parts: usize) -> Self {
        Self { period_s: self.period_s / parts as f64, samples: (self.samples - 1) * parts + 1 }
    }

    /// From the first to the last instant, s.
    #[must_use]
    pub fn duration_s(&self) -> f64 {
        (self.samples - 1) as f64 * self.period_s
    }

    /// The instants, s.
    #[must_use]
    pub fn times(&self) -> Vec<f64> {
        (0..self.samples).map(|i| i as f64 * self.period_s).collect()
    }
}

/// A motion at instants.
#[derive(Clone, Debug, Default)]
pub struct Trajectory {
    /// s.
    pub time: Vec<f64>,
    /// rad or m.
    pub position: Vec<f64>,
    /// rad/s or m/s.
    pub velocity: Vec<f64>,
    /// rad/s2 or m/s2.
    pub acceleration: Vec<f64>,
}

impl Trajectory {
    /// How many instants there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// The instants of these indices.
    #[must_use]
    pub fn at(&self, indices: &[usize]) -> Self {
        let picked = |values: &[f64]| indices.iter().map(|i| values[*i]).collect();
        Self {
            time: picked(&self.time),
            position: picked(&self.position),
            velocity: picked(&self.velocity),
            acceleration: picked(&self.acceleration),
        }
    }

    /// Every `step`-th instant.
    #[must_use]
    pub fn every(&self, step: usize) -> Self {
        self.at(&(0..self.len()).step_by(step).collect::<Vec<_>>())
    }

    /// A value of every instant.
    pub fn map(&self, value: impl Fn(f64, f64, f64, f64) -> f64) -> Vec<f64> {
        let one = |i: usize| value(self.time[i], self.position[i], self.velocity[i], self.acceleration[i]);
        (0..self.len()).map(one).collect()
    }

    fn of(grid: &Grid, state: impl Fn(f64) -> [f64; 3]) -> Self {
        let time = grid.times();
        let states: Vec<[f64; 3]> = time.iter().map(|t| state(*t)).collect();
        let part = |which: usize| states.iter().map(|state| state[which]).collect();
        Self { position: part(0), velocity: part(1), acceleration: part(2), time }
    }
}

/// A motion of which every random detail is drawn.
#[derive(Clone, Debug)]
pub enum Motion {
    /// Sines of several frequencies.
    Multisine(Multisine),
    /// The same, slower in parts of the recording.
    Gated(Multisine, Gate),
    /// A rising frequency at a speed that swells and ebbs.
    Chirp(Chirp),
    /// A rising frequency within reach and speed.
    Sweep(Sweep),
    /// One direction for long, at a speed that oscillates.
    Oscillation(Oscillation),
    /// Point to point with rests.
    Strokes(Strokes),
    /// Slow sines of a few sizes.
    SlowSines(SlowSines),
}

impl Motion {
    /// The motion at the instants of a grid.
    #[must_use]
    pub fn at(&self, grid: &Grid) -> Trajectory {
        match self {
            Self::Multisine(sines) => Trajectory::of(grid, |t| sines.state(t)),
            Self::Gated(sines, gate) => Trajectory::of(grid, |t| gate.slow_down(t, sines)),
            Self::Chirp(chirp) => chirp.at(grid),
            Self::Sweep(sweep) => sweep.at(grid),
            Self::Oscillation(oscillation) => oscillation.at(grid),
            Self::Strokes(strokes) => strokes.at(grid),
            Self::SlowSines(sines) => Trajectory::of(grid, |t| sines.state(t)),
        }
    }
}

#[cfg(test)]
mod tests;
