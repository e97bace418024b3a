//! Law and effects together, one sample after the other: what the compensator feeds forward and what a prediction replays.

use frikan_shared::effect::{Effect, MAX_EFFECTS};
use frikan_shared::elementary;
use frikan_shared::model::{Input, MAX_INPUTS, Model, RigidBody};
use frikan_shared::units::Quantity;

use crate::bounds::limited;
use crate::effects::{self, Contribution, Memory, Motion, contribution, frictional_lag, travel};
use crate::laws::evaluate::evaluate;
pub use crate::measurement::{Friction, Measurement};
use crate::usable::{Usable, finite, from_0_to, not_zero};

/// The memory of a model's effects, and of the way.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrictionState {
    pub(crate) memories: [Memory; MAX_EFFECTS],
    pub(crate) travel: Memory,
}

/// How warm a joint is that has no temperature sensor: what survives a reset, and a loss of power where the firmware keeps it.
///
/// Plain numbers, to be written anywhere and read back: the filtered dissipated power of each effect of the model, W, 0 for
/// effects that are no warm-up. What is negative, not finite or above the model's power limit is taken for the nearest that it may be, so that
/// the memory of another image, or damaged memory, does no harm.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Warmth {
    /// Filtered dissipated power by the place of the effect, W.
    pub power: [f32; MAX_EFFECTS],
}

impl Warmth {
    /// Nothing has dissipated for long.
    pub const COLD: Self = Self { power: [0.0; MAX_EFFECTS] };
}

impl FrictionState {
    /// At rest, cold, nothing wound up.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// At rest, nothing wound up, and as warm as `effects` are after a rest of so many seconds; cold where the rest is not
    /// positive, for then nothing is known of it.
    #[must_use]
    pub fn after_rest(&self, effects: &[Effect], rest: f32) -> Self {
        if rest > 0.0 { Self::with_warmth(&self.warmth(effects), effects, rest) } else { Self::default() }
    }

    /// The warmth that `effects` remember.
    #[must_use]
    pub fn warmth(&self, effects: &[Effect]) -> Warmth {
        let mut warmth = Warmth::COLD;
        for ((power, effect), memory) in warmth.power.iter_mut().zip(effects).zip(&self.memories) {
            *power = effects::warmth(effect, memory);
        }
        warmth
    }

    /// At rest, nothing wound up, and as warm as `effects` are `rest` seconds after `warmth`; a rest that is not positive is none.
    #[must_use]
    pub fn with_warmth(warmth: &Warmth, effects: &[Effect], rest: f32) -> Self {
        let rest = if rest > 0.0 { rest } else { 0.0 };
        let mut after = Self::default();
        for ((memory, effect), power) in after.memories.iter_mut().zip(effects).zip(warmth.power) {
            *memory = effects::warmed(effect, power, rest);
        }
        after
    }

    /// Advances by `dt` seconds and returns the friction at the end of them.
    ///
    /// A channel that the model reads and that is not finite, and a `dt` that is negative or not finite, give no friction and leave the
    /// memory as it was.
    #[must_use]
    pub fn step<const CELLS: usize>(&mut self, model: &Model<CELLS>, measurement: &Measurement, dt: f32) -> Friction {
        self.step_within(model, measurement, dt, from_0_to(f32::MAX, dt))
    }

    /// As [`FrictionState::step`]; `is_step` is negative where `dt` is a sample period. No branch depends on the sample.
    #[inline(always)]
    pub(crate) fn step_within<const CELLS: usize>(
        &mut self,
        model: &Model<CELLS>,
        measurement: &Measurement,
        dt: f32,
        is_step: i32,
    ) -> Friction {
        if !cfg!(feature = "effects") || model.effects.is_empty() {
            return law_alone(model, measurement, is_step);
        }
        let mut motion = Motion { angle: measurement.position, dt, ..Motion::default() };
        let mut channels = [0.0; MAX_INPUTS];
        let mut others = measurement.other.iter();
        let (mut usable, mut reads_position) = (is_step, false);
        for (channel, input) in channels.iter_mut().zip(&model.inputs) {
            *channel = measurement.channel(&input.quantity, &mut others);
            usable &= finite(*channel);
            reads_position |= input.quantity == Quantity::Position;
            motion.take(input, *channel);
        }
        let usable = Usable::where_negative(usable);
        motion.usable = usable;
        motion.travel = motion.velocity * dt;
        if reads_position {
            motion.travel = travel::step(&mut self.travel, motion.angle, usable);
        }
        if let ([Effect::FrictionalLag { time_constant }, ..], [memory, ..]) = (&model.effects[..], &mut self.memories)
        {
            let lagged = frictional_lag::step(*time_constant, memory, &motion);
            for (channel, input) in channels.iter_mut().zip(&model.inputs) {
                *channel = if input.quantity == Quantity::Velocity { lagged } else { *channel };
            }
        }
        motion.law_torque = evaluate(model, &channels);
        let mut sum = Contribution::torque(motion.law_torque);
        for (effect, memory) in model.effects.iter().zip(&mut self.memories) {
            let added = contribution(effect, memory, &motion, &model.cells);
            sum.torque += added.torque;
            sum.position += added.position;
        }
        let torque = usable.or_zero(limited(sum.torque, model.output_limit));
        Friction { torque, position: usable.or_zero(sum.position), usable }
    }
}

/// The friction of a model without effects; `is_step` is negative where the sample period is one.
#[inline(never)]
fn law_alone<const CELLS: usize>(model: &Model<CELLS>, measurement: &Measurement, is_step: i32) -> Friction {
    let channels = measurement.channels(&model.inputs);
    let usable = Usable::where_negative(channels.iter().fold(is_step, |usable, channel| usable & finite(*channel)));
    let torque = unless_at_rest(model, &channels, evaluate(model, &channels));
    Friction { torque: usable.or_zero(torque), position: 0.0, usable }
}

/// `torque` of the static law, or 0 where the velocity is 0: friction at rest is what holds the joint, and no law of the velocity knows it.
#[inline(always)]
fn unless_at_rest<const CELLS: usize>(model: &Model<CELLS>, channels: &[f32; MAX_INPUTS], torque: f32) -> f32 {
    let is_at_rest = |(input, channel): (&Input, &f32)| {
        if input.quantity == Quantity::Velocity { not_zero(*channel) } else { -1 }
    };
    let moves = model.inputs.iter().zip(channels).map(is_at_rest).fold(-1, |moves, channel| moves & channel);
    Usable::where_negative(moves).or_zero(torque)
}

/// Rigid-body torque in force for one sample: `inertia a + gravity_sin sin q + gravity_cos cos q + offset + given_scale given`.
#[must_use]
pub fn rigid_body_torque(body: &RigidBody, position: f32, acceleration: f32, given: f32) -> f32 {
    body.inertia * acceleration
        + body.gravity_sin * elementary::sin(position)
        + body.gravity_cos * elementary::cos(position)
        + body.offset
        + body.given_scale * given
}
