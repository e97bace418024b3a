//! What a recording holds, whether or not it is at fault: clock, resolution and limits of each channel, and what was driven. Values only;
//! judges nothing but what is plain.

use super::motion::{smooth, top_speed};
use crate::error::{Code, codes};
use crate::numerics::resolution::resolution;
use crate::numerics::statistics::quantile;
use crate::recording::{Channel, Quantity, Recording, STRETCH_ROWS};
use crate::samples::{Samples, VelocitySource};

/// Steps over the range of a channel from which it is coarse: fewer are told as a warning. Of 8 bits.
const COARSE_STEPS: f64 = 256.0;
/// Deviation of a step of the clock, in periods, from which it is uneven: values are interpolated by more than half a period then.
const UNEVEN: f64 = 0.5;
/// Speed over the top speed below which the joint is at rest, and up to which it is slow.
const REST: f64 = 0.01;
const SLOW: f64 = 0.1;
/// Temperature over which friction changes by several per cent, K: greases lose about 2 % of their viscosity a kelvin.
const TEMPERATURE_RANGE_K: f64 = 5.0;

/// One thing that was looked at.
#[derive(Clone, Debug, PartialEq)]
pub struct Fact {
    /// What.
    pub seen: Seen,
    /// Whether it limits what can be learnt.
    pub is_poor: bool,
    /// Stretches of time that it concerns, s; empty where it is the whole recording.
    pub when_s: Vec<[f64; 2]>,
}

/// What was looked at. Positions are in rad or m, torques in the unit of the actuator.
#[derive(Clone, Debug, PartialEq)]
pub enum Seen {
    /// The clock.
    Clock {
        /// Rows.
        rows: usize,
        /// Median period, s.
        period_s: f64,
        /// Largest deviation of a step from it, periods.
        jitter: f64,
    },
    /// Interruptions of the clock.
    Gaps {
        /// How many.
        count: usize,
    },
    /// The step of a channel.
    Resolution {
        /// Name of the channel.
        channel: String,
        /// Its SI unit.
        unit: &'static str,
        /// The step; 0 where it has none.
        step: f64,
        /// Range of its values.
        range: f64,
    },
    /// A channel that is the same in every row.
    Constant {
        /// Name of the channel.
        channel: String,
        /// The value.
        value: f64,
    },
    /// Rows in which the actuator stands at its largest or smallest value.
    AtLimit {
        /// Name of the channel.
        channel: String,
        /// Share of the rows, 0 to 1.
        share: f64,
    },
    /// What was driven.
    Motion(Motion),
    /// The temperature.
    Temperature {
        /// Lowest and highest, degrees Celsius.
        range: [f64; 2],
    },
}

/// What was driven.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Range of the position, rad or m.
    pub travel: f64,
    /// Speed that is exceeded rarely, rad/s or m/s.
    pub top_speed: f64,
    /// Share of the time at rest.
    pub at_rest: f64,
    /// Share of the time in slow motion, below a tenth of the top speed.
    pub slow: f64,
    /// How often the joint turns round.
    pub reversals: usize,
}

impl Seen {
    /// Entry of the registry.
    #[must_use]
    pub fn code(&self) -> &'static Code {
        match self {
            Self::Clock { .. } => &codes::CLOCK,
            Self::Gaps { .. } => &codes::GAPS,
            Self::Resolution { .. } => &codes::RESOLUTION,
            Self::Constant { .. } => &codes::CONSTANT_CHANNEL,
            Self::AtLimit { .. } => &codes::AT_LIMIT,
            Self::Motion(_) => &codes::MOTION,
            Self::Temperature { .. } => &codes::TEMPERATURE_RANGE,
        }
    }
}

/// Looks at a recording that has been reviewed.
#[must_use]
pub fn survey(recording: &Recording) -> Vec<Fact> {
    let fact = |seen, is_poor| Fact { seen, is_poor, when_s: Vec::new() };
    let health = &recording.health;
    let mut facts = Vec::new();
    if let Some(period_s) = health.period_s {
        let seen = Seen::Clock { rows: recording.len(), period_s, jitter: health.jitter };
        facts.push(fact(seen, health.jitter > UNEVEN));
    }
    let gaps = gaps(recording);
    if !gaps.is_empty() {
        facts.push(Fact { seen: Seen::Gaps { count: gaps.len() }, is_poor: true, when_s: gaps });
    }
    let measured = |channel: &&Channel| channel.quantity.is_some_and(|quantity| quantity != Quantity::Time);
    for channel in recording.channels.iter().filter(measured) {
        let [low, high] = [0.0, 1.0].map(|share| quantile(channel.values.iter().copied(), share));
        let name = channel.name.clone();
        if low == high {
            facts.push(fact(Seen::Constant { channel: name, value: low }, true));
            continue;
        }
        let step = resolution(&channel.values).unwrap_or(0.0);
        let seen = Seen::Resolution { channel: name, unit: channel.unit, step, range: high - low };
        facts.push(fact(seen, step * COARSE_STEPS > high - low));
    }
    if let Some(channel) = recording.actuator().filter(|_| health.clipped_rows > 0) {
        let share = health.clipped_rows as f64 / recording.len() as f64;
        facts.push(fact(Seen::AtLimit { channel: channel.name.clone(), share }, true));
    }
    if let Some(motion) = smooth(recording, VelocitySource::Derived).and_then(|samples| Motion::of(&samples)) {
        facts.push(fact(Seen::Motion(motion), motion.reversals == 0));
    }
    if let Some(temperature) = recording.values(Quantity::Temperature) {
        let range = [0.0, 1.0].map(|share| quantile(temperature.iter().copied(), share));
        facts.push(fact(Seen::Temperature { range }, range[1] - range[0] < TEMPERATURE_RANGE_K));
    }
    facts
}

/// Interruptions of the clock, from and to, s; between two stretches of an excerpt, at least one of which was left out, there is none.
fn gaps(recording: &Recording) -> Vec<[f64; 2]> {
    let Some(time) = recording.values(Quantity::Time) else { return Vec::new() };
    let left_out_s = (STRETCH_ROWS - 1) as f64 * recording.health.period_s.unwrap_or(f64::INFINITY);
    let around = recording.health.gaps.iter().map(|row| [time[row - 1], time[*row]]);
    around.filter(|[from, to]| !(recording.is_excerpt && to - from >= left_out_s)).collect()
}

impl Motion {
    fn of(samples: &Samples) -> Option<Self> {
        let (position, velocity) = (samples.position.as_deref()?, samples.velocity.as_deref()?);
        let top_speed = top_speed(velocity);
        let [low, high] = [0.0, 1.0].map(|share| quantile(position.iter().copied(), share));
        let share = |is: &dyn Fn(f64) -> bool| {
            velocity.iter().filter(|v| is(v.abs())).count() as f64 / velocity.len().max(1) as f64
        };
        // Rest between two strokes is no reversal of its own.
        let moving: Vec<f64> = velocity.iter().copied().filter(|v| v.abs() > REST * top_speed).collect();
        Some(Self {
            travel: high - low,
            top_speed,
            at_rest: share(&|speed| speed <= REST * top_speed),
            slow: share(&|speed| speed > REST * top_speed && speed <= SLOW * top_speed),
            reversals: moving.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count(),
        })
    }
}
