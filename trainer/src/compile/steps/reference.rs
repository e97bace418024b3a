//! The compensator's step as the trainer computes it: written apart from the runtime, from the specification of the image format and of
//! each effect. What it shares with the runtime is what *defines* a model: the order of every rounding, and the elementary functions.

use frikan_runtime::friction::Measurement;
use frikan_shared::effect::Effect;
use frikan_shared::model::{MAX_INPUTS, Model};
use frikan_shared::units::Quantity;

use super::effects::{Added, Memory, Seen};
use super::{Answer, Call, POSITION_LIMIT};
use crate::compile::reference::evaluate_one;

/// Longest sample period that a step takes, s.
const LONGEST_SAMPLE: f32 = 1.0;

/// A compensator; `E` is what an effect adds in one sample, the reference's own or, in a test of the comparison, a wrong one.
#[derive(Clone, Debug)]
pub struct Reference<'a, const CELLS: usize, E> {
    model: &'a Model<CELLS>,
    effect: E,
    memories: Vec<Memory>,
    /// Position of the sample before.
    position: Option<f32>,
    /// The limits in force: gain, torque, slew.
    limits: [f32; 3],
    /// Largest position that is put out: none before limits are in force.
    position_limit: f32,
    /// What was put out last.
    torque: f32,
}

impl<'a, const CELLS: usize, E: Fn(&Effect, &mut Memory, &Seen<'_>) -> Added> Reference<'a, CELLS, E> {
    /// A compensator at its start.
    #[must_use]
    pub fn new(model: &'a Model<CELLS>, effect: E) -> Self {
        let memories = vec![None; model.effects.len()];
        Self { model, effect, memories, position: None, limits: [0.0; 3], position_limit: 0.0, torque: 0.0 }
    }

    /// The answer to a call.
    pub fn step(&mut self, call: &Call) -> Answer {
        if call.reset {
            for (memory, effect) in self.memories.iter_mut().zip(&self.model.effects) {
                // The warmth stays, without what rounding put in too much.
                let is_warm = matches!(effect, Effect::WarmUp { .. });
                *memory = memory.filter(|_| is_warm).map(|[heat, ..]| [heat, 0.0, 0.0, 0.0]);
            }
            self.position = None;
            self.torque = 0.0;
        }
        let [gain, torque, slew] = call.limits;
        if call.limits.iter().all(|limit| *limit >= 0.0 && limit.is_finite()) && slew > 0.0 {
            self.limits = [gain, torque, slew].map(f32::abs);
            self.position_limit = POSITION_LIMIT;
        }
        let [gain, most, slew] = self.limits;
        let channels = channels(self.model, &call.measurement);
        let is_usable =
            channels.iter().all(|channel| channel.is_finite()) && call.dt > 0.0 && call.dt <= LONGEST_SAMPLE;
        if !is_usable {
            self.torque = 0.0;
            return Answer::new(0.0, 0.0, false);
        }
        let friction = self.friction(&channels, &call.measurement, call.dt);
        let reach = slew * call.dt;
        let wanted = (gain * friction.torque).clamp(-most, most);
        let change = wanted - self.torque;
        self.torque = wanted - (change - change.clamp(-reach, reach));
        Answer::new(self.torque, friction.position.clamp(-self.position_limit, self.position_limit), true)
    }

    /// Law and effects of one sample.
    fn friction(&mut self, channels: &[f32], measurement: &Measurement, dt: f32) -> Added {
        let inputs = &self.model.inputs;
        let held: Vec<f32> = inputs.iter().zip(channels).map(|(input, x)| x.clamp(input.low, input.high)).collect();
        let of = |quantity: Quantity| inputs.iter().zip(&held).find(|(input, _)| input.quantity == quantity);
        let held_or_zero = |quantity| of(quantity).map_or(0.0, |(_, value)| *value);
        let velocity = held_or_zero(Quantity::Velocity);
        let before = self.position.replace(measurement.position);
        let mut seen = Seen {
            velocity,
            position: held_or_zero(Quantity::Position),
            angle: measurement.position,
            travel: match of(Quantity::Position) {
                Some(_) => before.map_or(0.0, |before| measurement.position - before),
                None => velocity * dt,
            },
            load: held_or_zero(Quantity::Load),
            temperature: held_or_zero(Quantity::Temperature),
            law: 0.0,
            dt,
            cells: &self.model.cells,
        };
        // A lag tells the law a velocity; every other effect is asked what it adds to the law.
        let mut to_law: Vec<f32> = channels.to_vec();
        let (lags, others): (Vec<_>, Vec<_>) = (self.model.effects.iter().zip(&mut self.memories))
            .partition(|(effect, _)| matches!(effect, Effect::FrictionalLag { .. }));
        let is_lagged = !lags.is_empty();
        for (effect, memory) in lags {
            let lagged = (self.effect)(effect, memory, &seen).velocity;
            for (value, input) in to_law.iter_mut().zip(inputs) {
                if input.quantity == Quantity::Velocity {
                    *value = lagged;
                }
            }
        }
        let is_at_rest = inputs.iter().zip(&to_law).any(|(input, x)| input.quantity == Quantity::Velocity && *x == 0.0);
        let is_static = self.model.effects.is_empty();
        seen.law = if is_static && is_at_rest { 0.0 } else { evaluate_one(self.model, &padded(&to_law)) };
        let mut sum = Added { torque: seen.law, ..Added::default() };
        if is_lagged {
            // A lag adds the number 0, which takes the sign from a negative zero.
            sum.torque += 0.0;
        }
        for (effect, memory) in others {
            let added = (self.effect)(effect, memory, &seen);
            sum.torque += added.torque;
            sum.position += added.position;
        }
        sum.torque = sum.torque.clamp(-self.model.output_limit, self.model.output_limit);
        sum
    }
}

/// The channels of the model's inputs, in their order.
fn channels<const CELLS: usize>(model: &Model<CELLS>, measurement: &Measurement) -> Vec<f32> {
    let mut others = 0;
    let mut channel = |quantity: &Quantity| match quantity {
        Quantity::Velocity => measurement.velocity,
        Quantity::Position => measurement.position,
        Quantity::Acceleration => measurement.acceleration,
        Quantity::Load => measurement.load,
        Quantity::Temperature => measurement.temperature,
        Quantity::Other(_) => {
            others += 1;
            measurement.other[others - 1]
        }
    };
    model.inputs.iter().map(|input| channel(&input.quantity)).collect()
}

fn padded(channels: &[f32]) -> [f32; MAX_INPUTS] {
    std::array::from_fn(|index| channels.get(index).copied().unwrap_or(0.0))
}
