//! From a recording to samples: filters, derivatives, rigid body removed, blocks. Knows no model.
//!
//! [`Preparation::plan`] chooses one filter for all recordings, [`prepare`] applies it alike to every channel, and
//! [`rigid_body::separate`] takes the rigid body off the actuator's torque.

pub mod blocks;
pub(crate) mod delay;
mod even;
mod grid;
pub mod hold_out;
pub mod plan;
mod position_noise;
mod prepare;
pub mod relevance;
pub mod separation;
pub mod spikes;
pub(crate) mod states;
#[cfg(test)]
mod tests;
mod width;

use std::ops::Range;

pub use even::EvenClock;
pub(crate) use grid::{interpolate, told_of_clock};
pub use plan::{Preparation, Request, VelocitySource};
pub(crate) use position_noise::{PositionNoise, white_position_noise};
pub(crate) use prepare::{EveryRow, prepare_every_row_of};
pub use prepare::{prepare, prepare_every_row};
pub(crate) use separation::bending::BendingLaw;
pub(crate) use separation::lead;
pub use separation::rigid_body;
pub(crate) use width::{STEP as WIDTH_STEP, smooth_friction_columns, thinned};

use crate::did_you_mean::hint;
use crate::error::{Error, Result, codes};
use crate::numerics::statistics::quantile;
use crate::recording::Axis;

/// Quantile of the speed that counts as the top speed; what is above may be noise.
const TOP_QUANTILE: f64 = 0.999;

/// Speed over the top speed above which a joint slides: its friction curve is Coulomb and viscous. Chosen by judgement: below it friction may
/// still fall from break-away, which would count as Coulomb torque, and presliding and lag look like a delay; higher leaves too few samples.
pub(crate) const SLIDING_SPEED_SHARE: f64 = 0.2;

/// Speed that all but a thousandth of the samples stay below, in the unit of the velocity.
pub(crate) fn top_speed(velocity: &[f64]) -> f64 {
    quantile(velocity.iter().map(|v| v.abs()), TOP_QUANTILE)
}

/// Filtered samples on a uniform grid, segment after segment; every list has the same length.
#[derive(Clone, Debug)]
pub struct Samples {
    /// Rotary (rad, N m) or linear (m, N).
    pub axis: Axis,
    /// Time, s; empty for separated recordings without a clock.
    pub time: Vec<f64>,
    /// Position, rad or m.
    pub position: Option<Vec<f64>>,
    /// Velocity, rad/s or m/s.
    pub velocity: Option<Vec<f64>>,
    /// Acceleration, rad/s2 or m/s2.
    pub acceleration: Option<Vec<f64>>,
    /// Actuator torque, force or current.
    pub actuator: Option<Vec<f64>>,
    /// Unit of actuator, rigid body and friction: `Nm`, `N` or `A`.
    pub actuator_unit: &'static str,
    /// Rigid-body torque as recorded, in the unit of the actuator.
    pub rigid_body: Option<Vec<f64>>,
    /// Friction, when the recording holds it already separated.
    pub friction: Option<Vec<f64>>,
    /// Separated friction, or else the actuator, as recorded at these instants: what a prediction is scored on.
    pub recorded: Option<Vec<f64>>,
    /// Every other channel by its name as an input of a model.
    pub channels: Vec<(String, Vec<f64>)>,
    /// Uninterrupted stretches.
    pub segments: Vec<Range<usize>>,
    /// Label of each recording with its samples, in the order given.
    pub recordings: Vec<(String, Range<usize>)>,
    /// Samples per second; `None` without a clock.
    pub rate_hz: Option<f64>,
    /// Standard deviation of the filter, s; `None` where nothing was filtered.
    pub sigma_s: Option<f64>,
    /// The filter and where velocity comes from, in one sentence.
    pub filter: String,
}

impl Samples {
    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        self.recordings.last().map_or(0, |(_, range)| range.end)
    }

    /// Whether there is no sample.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Share of a sine of the position that passes the filter at a sample: within its window the joint moves on at the velocity v, and the average
    /// of `sin(q + v s)` over a Gaussian of deviation sigma is `sin(q) exp(-(sigma v)^2 / 2)` (its characteristic function).
    pub(crate) fn passed_share_of_sine(&self, row: usize) -> f64 {
        let way = self.sigma_s.zip(self.velocity.as_deref()).map_or(0.0, |(sigma_s, velocity)| sigma_s * velocity[row]);
        (-0.5 * way * way).exp()
    }

    /// The values that a model's input of this name takes: `velocity`, `position`, `acceleration`, or a channel.
    #[must_use]
    pub fn input(&self, name: &str) -> Option<&[f64]> {
        match name {
            "velocity" => self.velocity.as_deref(),
            "position" => self.position.as_deref(),
            "acceleration" => self.acceleration.as_deref(),
            "load" | "load_torque" => self.channel("load_torque"),
            "rigid_body_torque" => self.rigid_body.as_deref(),
            other => self.channel(other),
        }
    }

    fn channel(&self, name: &str) -> Option<&[f64]> {
        self.channels.iter().find(|(own, _)| own == name).map(|(_, values)| values.as_slice())
    }

    /// Names that [`input`](Self::input) answers to, apart from aliases.
    #[must_use]
    pub fn input_names(&self) -> Vec<&str> {
        let standard = ["velocity", "position", "acceleration", "rigid_body_torque"];
        let mut names: Vec<&str> = standard.into_iter().filter(|name| self.input(name).is_some()).collect();
        names.extend(self.channels.iter().map(|(name, _)| name.as_str()));
        names
    }

    /// The values of an input.
    ///
    /// # Errors
    /// `FRK-U002` with the names that exist.
    pub fn require_input(&self, name: &str) -> Result<&[f64]> {
        self.input(name).ok_or_else(|| {
            let names = self.input_names();
            let near = hint(name, names.iter().copied());
            let message = format!("there is no such input{near}; this recording has: {}", names.join(", "));
            Error::new(&codes::UNKNOWN_INPUT, message).with_value(name)
        })
    }

    /// The velocity.
    ///
    /// # Errors
    /// `FRK-D009` when the recording has none and none can be derived.
    pub fn require_velocity(&self) -> Result<&[f64]> {
        self.velocity.as_deref().ok_or_else(|| {
            Error::new(&codes::MISSING_COLUMN, "friction over velocity needs velocity, or position and time")
                .in_column("velocity_rad_s")
        })
    }

    /// One set from the samples of several recordings of the same joint, in the order given.
    ///
    /// # Errors
    /// `FRK-D018` when axis, unit or channels differ, or when `parts` is empty.
    pub fn join(parts: Vec<Self>) -> Result<Self> {
        let mut parts = parts.into_iter();
        let Some(mut all) = parts.next() else {
            return Err(Error::new(&codes::RECORDINGS_DISAGREE, "no recording is given"));
        };
        for part in parts {
            all.append(part)?;
        }
        Ok(all)
    }

    fn append(&mut self, part: Self) -> Result<()> {
        let label = part.recordings.first().map_or_else(String::new, |(label, _)| label.clone());
        let disagree = |what: &str| {
            Error::new(&codes::RECORDINGS_DISAGREE, format!("this recording differs in {what} from the first"))
                .in_file(label.clone())
        };
        if self.axis != part.axis {
            return Err(disagree("the kind of its axis"));
        }
        if self.actuator_unit != part.actuator_unit {
            return Err(disagree("the unit of its actuator"));
        }
        let start = self.len();
        let mut lists = [
            (&mut self.position, part.position, "position"),
            (&mut self.velocity, part.velocity, "velocity"),
            (&mut self.acceleration, part.acceleration, "acceleration"),
            (&mut self.actuator, part.actuator, "its actuator"),
            (&mut self.rigid_body, part.rigid_body, "rigid-body torque"),
            (&mut self.friction, part.friction, "separated friction"),
            (&mut self.recorded, part.recorded, "its actuator"),
        ];
        for (own, other, name) in &mut lists {
            match (own.as_mut(), other.take()) {
                (Some(own), Some(other)) => own.extend(other),
                (None, None) => {}
                _ => return Err(disagree(name)),
            }
        }
        // Channels that only some recordings have cannot serve as inputs.
        self.channels.retain(|(name, _)| part.channels.iter().any(|(other, _)| other == name));
        for (name, values) in part.channels {
            if let Some((_, own)) = self.channels.iter_mut().find(|(own, _)| *own == name) {
                own.extend(values);
            }
        }
        self.time.extend(part.time);
        let shift = |range: Range<usize>| range.start + start..range.end + start;
        self.segments.extend(part.segments.into_iter().map(shift));
        self.recordings.extend(part.recordings.into_iter().map(|(label, range)| (label, shift(range))));
        Ok(())
    }
}
