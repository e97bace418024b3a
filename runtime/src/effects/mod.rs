//! The correction terms, one file a kind: fixed cost, bounded state, no input by which they could fail.

pub mod channels;
pub mod dwell_breakaway;
pub mod frictional_lag;
pub mod play;
pub mod position;
pub mod presliding;
pub mod velocity;
pub mod warm_up;
pub mod windup;

use frikan_shared::effect::{Effect, Kind};
use frikan_shared::elementary::tanh;
use frikan_shared::model::{Input, MAX_INPUTS};
use frikan_shared::pool::Pool;
use frikan_shared::units::Quantity;

/// One sample as the effects see it: channels held to their trained ranges, 0 where the model has no such channel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Velocity, rad/s.
    pub velocity: f32,
    /// Position, rad.
    pub position: f32,
    /// Position as measured, for what repeats with it, rad.
    pub angle: f32,
    /// Transmitted torque, N m.
    pub load: f32,
    /// Temperature, degC.
    pub temperature: f32,
    /// Friction of the static law, N m.
    pub law_torque: f32,
    /// Sample period, s, finite and not negative.
    pub dt: f32,
}

impl Motion {
    /// The sample with the channels that `inputs` name.
    #[must_use]
    pub fn new(inputs: &[Input], held: &[f32; MAX_INPUTS], angle: f32, dt: f32) -> Self {
        let mut motion = Self { angle, dt, ..Self::default() };
        for (value, input) in held.iter().zip(inputs) {
            match input.quantity {
                Quantity::Velocity => motion.velocity = *value,
                Quantity::Position => motion.position = *value,
                Quantity::Load => motion.load = *value,
                Quantity::Temperature => motion.temperature = *value,
                Quantity::Acceleration | Quantity::Other(_) => {}
            }
        }
        motion
    }

    /// `s(v) = tanh(v / smoothing_velocity)`.
    #[must_use]
    #[inline]
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

/// The memory of one effect.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum State {
    /// The effect has none.
    None,
    /// Of a frictional lag.
    Lag(frictional_lag::Lag),
    /// Of presliding.
    Bristle(presliding::Bristle),
    /// Of a dwell breakaway.
    Dwell(dwell_breakaway::Dwell),
    /// Of a warm-up.
    Heat(warm_up::Heat),
    /// Of a play.
    Link(play::Link),
    /// Of a windup hysteresis.
    Winding(windup::Winding),
}

impl State {
    /// The memory of `effect` at the start.
    #[must_use]
    pub fn new(effect: &Effect) -> Self {
        match effect {
            Effect::FrictionalLag { .. } => Self::Lag(frictional_lag::Lag::default()),
            Effect::Presliding { .. } => Self::Bristle(presliding::Bristle::default()),
            Effect::DwellBreakaway { .. } => Self::Dwell(dwell_breakaway::Dwell::default()),
            Effect::WarmUp { .. } => Self::Heat(warm_up::Heat::default()),
            Effect::Play { .. } => Self::Link(play::Link::default()),
            Effect::WindupHysteresis { .. } => Self::Winding(windup::Winding::default()),
            _ => Self::None,
        }
    }

    /// The memory of `effect` after a rest of so many seconds: its warmth has faded, the rest is as at the start.
    #[must_use]
    pub fn after_rest(&self, effect: &Effect, rest: f32) -> Self {
        match self {
            Self::Heat(heat) => Self::Heat(heat.after_rest(effect, rest)),
            _ => Self::new(effect),
        }
    }
}

/// Advances `state` by one sample and returns what `effect` adds. A state that is not the effect's adds nothing.
#[must_use]
pub fn contribution<const CELLS: usize>(
    effect: &Effect,
    state: &mut State,
    motion: &Motion,
    pool: &Pool<CELLS>,
) -> Contribution {
    match (effect, state) {
        (Effect::Presliding { .. }, State::Bristle(bristle)) => presliding::step(effect, bristle, motion),
        (Effect::DwellBreakaway { .. }, State::Dwell(dwell)) => dwell_breakaway::step(effect, dwell, motion),
        (Effect::WarmUp { .. }, State::Heat(heat)) => warm_up::step(effect, heat, motion),
        (Effect::Play { half_width, torque }, State::Link(link)) => play::step(*half_width, *torque, link, motion),
        (Effect::WindupHysteresis { torque, distance }, State::Winding(winding)) => {
            windup::step(*torque, *distance, winding, motion)
        }
        (Effect::Temperature { .. } | Effect::Load { .. }, _) => Contribution::torque(channels::torque(effect, motion)),
        (Effect::Ripple { .. } | Effect::PositionTable { .. } | Effect::Spring { .. }, _) => {
            position::contribution(effect, motion, pool)
        }
        _ => Contribution::torque(velocity::torque(effect, motion)),
    }
}

#[cfg(test)]
mod tests;
