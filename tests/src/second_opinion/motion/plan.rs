//! Which kind of motion a case asks for, and the draw of its details.

use super::{Chirp, Gate, Grid, Motion, Multisine, Oscillation, SlowSines, Strokes, Sweep};
use crate::second_opinion::joint::Joint;
use crate::second_opinion::random::{Random, factor, phase};

/// A kind of motion with what a case fixes of it.
#[derive(Clone, Copy, Debug)]
pub enum Plan {
    /// Six lines, logarithmically spaced from the first to the last frequency.
    Multisine {
        /// First and last line, Hz.
        hz: [f64; 2],
    },
    /// The same, slowed down in parts.
    Pausing {
        /// First and last line, Hz.
        hz: [f64; 2],
        /// Slow spans as shares of the recording.
        spans: &'static [(f64, f64)],
        /// Share of the speed that is taken away.
        depth: f64,
    },
    /// A rising frequency at a speed that swells and ebbs.
    Chirp {
        /// First and last frequency, Hz.
        hz: [f64; 2],
    },
    /// Strokes of one length.
    BackAndForth {
        /// Length, rad or m; the way of 1.2 s at top speed where absent.
        stroke: Option<f64>,
        /// Acceleration, rad/s2 or m/s2; top speed in a quarter of a second where absent.
        acceleration: Option<f64>,
        /// Rests to choose from, s.
        dwells_s: &'static [f64],
    },
    /// Long in one direction at an oscillating speed.
    Oscillation,
    /// Slow sines, from one to sixty of this unit (rad or m).
    SlowSines {
        /// rad or m.
        unit: f64,
    },
    /// Five lines from 0.11 to 1.31 Hz times a factor.
    Lines {
        /// Factor of the frequencies.
        times: f64,
    },
    /// From 0.1 to 2.5 Hz within reach and speed.
    Sweep,
    /// Point to point within reach.
    PointToPoint,
    /// Point to point over several turns.
    ManyTurns,
}

/// A plain multisine.
pub const MULTISINE: Plan = Plan::Multisine { hz: [0.1, 1.5] };
/// A plain chirp.
pub const CHIRP: Plan = Plan::Chirp { hz: [0.1, 2.0] };
/// Plain strokes.
pub const STROKES: Plan = Plan::BackAndForth { stroke: None, acceleration: None, dwells_s: &[0.0, 0.1, 0.3, 0.6, 1.0] };

/// Frequencies (Hz) and amplitudes of the five lines.
const LINES: [[f64; 2]; 5] = [[0.11, 1.0], [0.23, 0.6], [0.47, 0.35], [0.83, 0.15], [1.31, 0.06]];
/// Lines of a multisine.
const COUNT: usize = 6;
/// Power of the frequency with which the velocity of a line falls.
const FALL: f64 = 0.6;

impl Plan {
    /// Draws the details for a recording of `grid`.
    pub fn draw(&self, joint: &Joint, grid: &Grid, random: &mut Random) -> Motion {
        let duration_s = grid.duration_s();
        let top_speed = joint.top_speed;
        match *self {
            Self::Multisine { hz } => Motion::Multisine(multisine(hz, joint, grid, random)),
            Self::Pausing { hz, spans, depth } => {
                let shift = random.uniform(-0.03, 0.03);
                let spans_s = spans.iter().map(|(a, b)| ((a + shift) * duration_s, (b + shift) * duration_s)).collect();
                Motion::Gated(multisine(hz, joint, grid, random), Gate { spans_s, depth })
            }
            Self::Chirp { hz } => {
                let hz = hz.map(|hz| hz * random.uniform(0.9, 1.1));
                Motion::Chirp(Chirp { hz, top_speed, duration_s, phases: [phase(random), phase(random)] })
            }
            Self::BackAndForth { stroke, acceleration, dwells_s } => {
                let stroke = stroke.unwrap_or(1.2 * top_speed) * random.uniform(0.95, 1.05);
                let acceleration = acceleration.unwrap_or(top_speed / 0.25);
                Motion::Strokes(Strokes::back_and_forth(joint, stroke, acceleration, dwells_s, duration_s, random))
            }
            Self::Oscillation => {
                let phases = [random.uniform(0.2, 0.6), phase(random), phase(random)];
                Motion::Oscillation(Oscillation { top_speed, duration_s, phases })
            }
            Self::SlowSines { unit } => Motion::SlowSines(SlowSines { unit: unit * factor(random), duration_s }),
            Self::Lines { times } => {
                let lines = LINES.map(|[hz, amplitude]| [hz * times, amplitude]);
                Motion::Multisine(Multisine::draw(&lines, top_speed, joint.reach, grid, random))
            }
            Self::Sweep => {
                let hz = [0.1, 2.5].map(|hz| hz * random.uniform(0.9, 1.1));
                Motion::Sweep(Sweep { hz, top_speed, reach: joint.reach, duration_s })
            }
            Self::PointToPoint => Motion::Strokes(Strokes::point_to_point(joint, duration_s, random)),
            Self::ManyTurns => Motion::Strokes(Strokes::many_turns(joint, duration_s, random)),
        }
    }

    /// What it is called on the page.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Multisine { .. } | Self::Lines { .. } => "multisine",
            Self::Pausing { .. } => "multisine with slow spans",
            Self::Chirp { .. } | Self::Sweep => "chirp",
            Self::BackAndForth { .. } => "back and forth",
            Self::Oscillation => "oscillating speed",
            Self::SlowSines { .. } => "slow sines",
            Self::PointToPoint => "point to point",
            Self::ManyTurns => "many turns",
        }
    }
}

fn multisine([lowest, highest]: [f64; 2], joint: &Joint, grid: &Grid, random: &mut Random) -> Multisine {
    let line = |index: usize| {
        let hz = lowest * (highest / lowest).powf(index as f64 / (COUNT - 1) as f64) * random.uniform(0.9, 1.1);
        [hz, hz.powf(-1.0 - FALL)]
    };
    let lines: Vec<[f64; 2]> = (0..COUNT).map(line).collect();
    Multisine::draw(&lines, joint.top_speed, f64::INFINITY, grid, random)
}
