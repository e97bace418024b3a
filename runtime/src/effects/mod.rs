//! The correction terms, one file a kind: fixed cost, bounded state, no input by which they could fail.

pub mod channels;
pub mod dwell_breakaway;
pub mod frictional_lag;
pub mod play;
pub mod position;
pub mod presliding;
pub mod travel;
pub mod velocity;
pub mod warm_up;
pub mod windup;

use frikan_shared::effect::{Effect, Kind};
use frikan_shared::elementary::tanh;
use frikan_shared::model::Input;
use frikan_shared::pool::Pool;
use frikan_shared::units::Quantity;

use crate::laws::evaluate::held;
use crate::usable::Usable;

/// One sample as the effects see it: channels held to their trained ranges, 0 where the model has no such channel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Velocity, rad/s.
    pub velocity: f32,
    /// Position, rad.
    pub position: f32,
    /// Transmitted torque, N m.
    pub load: f32,
    /// Temperature, degC.
    pub temperature: f32,
    /// Position as measured, for what repeats with it, rad.
    pub angle: f32,
    /// Friction of the static law, N m.
    pub law_torque: f32,
    /// Sample period, s.
    pub dt: f32,
    /// Distance since the sample before, rad.
    pub travel: f32,
    /// Whether channels and sample period are finite; else nothing of the sample may be remembered.
    pub usable: Usable,
}

impl Motion {
    /// Takes a channel that the model reads.
    #[inline(always)]
    pub(crate) fn take(&mut self, input: &Input, channel: f32) {
        let value = held(input, channel);
        match input.quantity {
            Quantity::Velocity => self.velocity = value,
            Quantity::Position => self.position = value,
            Quantity::Load => self.load = value,
            Quantity::Temperature => self.temperature = value,
            Quantity::Acceleration | Quantity::Other(_) => {}
        }
    }

    /// `s(v) = tanh(v / smoothing_velocity)`.
    #[must_use]
    #[inline(always)]
    pub fn smooth_sign(&self, smoothing_velocity: f32) -> f32 {
        tanh(self.velocity / smoothing_velocity)
    }
}

/// What an effect adds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contribution {
    /// Torque, N m.
    pub torque: f32,
    /// Position of the link against the motor, rad.
    pub position: f32,
}

impl Contribution {
    /// Torque alone.
    #[must_use]
    pub const fn torque(torque: f32) -> Self {
        Self { torque, position: 0.0 }
    }

    /// A value as what `kind` says.
    fn of_kind(kind: Kind, value: f32, smooth_sign: f32) -> Self {
        match kind {
            Kind::Torque => Self::torque(value),
            Kind::Friction => Self::torque(value * smooth_sign),
            Kind::Position => Self { torque: 0.0, position: value },
        }
    }
}

/// The memory of one effect: up to four numbers, of which the effect says what they are, all 0 at the start.
pub type Memory = [f32; 4];

/// What a memory holds that has seen a sample, where that is asked for.
const STARTED: f32 = 1.0;

/// The warmth that `effect` remembers, W; 0 where it is no warm-up.
#[must_use]
pub fn warmth(effect: &Effect, [heat, ..]: &Memory) -> f32 {
    if let Effect::WarmUp { .. } = effect { *heat } else { 0.0 }
}

/// The memory of `effect` a rest of so many seconds after it was as warm as `power`, W: the warmth has faded, the rest is as at the start.
#[must_use]
pub fn warmed(effect: &Effect, power: f32, rest: f32) -> Memory {
    match *effect {
        Effect::WarmUp { time_constant, power_limit, .. } => {
            let power = if power > 0.0 { power.min(power_limit) } else { 0.0 };
            warm_up::after_rest(time_constant, power, rest)
        }
        _ => Memory::default(),
    }
}

/// Advances `memory` by one sample and returns what `effect` adds; a lag adds nothing.
#[must_use]
#[inline(always)]
pub fn contribution<const CELLS: usize>(
    effect: &Effect,
    memory: &mut Memory,
    motion: &Motion,
    pool: &Pool<CELLS>,
) -> Contribution {
    match effect {
        Effect::Presliding { smoothing_velocity, elements } => {
            presliding::call(*smoothing_velocity, elements, memory, motion)
        }
        Effect::DwellBreakaway { .. } => dwell_breakaway::step(effect, memory, motion),
        Effect::WarmUp { .. } => warm_up::step(effect, memory, motion),
        Effect::Play { half_width, torque } => play::step(*half_width, *torque, memory, motion),
        Effect::WindupHysteresis { torque, distance } => windup::step(*torque, *distance, memory, motion),
        Effect::Temperature { .. } | Effect::Load { .. } => Contribution::torque(channels::torque(effect, motion)),
        Effect::Ripple { .. } | Effect::PositionTable { .. } | Effect::Spring { .. } => {
            position::contribution(effect, motion, pool)
        }
        _ => Contribution::torque(velocity::torque(effect, motion)),
    }
}

#[cfg(test)]
mod tests;
