//! What a compensator is stepped through: motions over and beyond the trained ranges, at every scale of speed, distance and time, with
//! reversals, dwells, jumps, missing samples, special values, resets and changes of the limits. One model, one sequence.

use std::f32::consts::TAU;

use frikan_runtime::friction::Measurement;
use frikan_shared::model::{MAX_INPUTS, Model};
use frikan_shared::units::Quantity;
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{RngCore, SeedableRng};

use super::Call;
use crate::compile::verify::SPECIAL_VALUES;

/// Steps of one kind of motion with one scale, one sample period and one set of limits.
const SEGMENT: usize = 250;

/// Channels of a measurement: velocity, position, acceleration, load, temperature and the others.
const CHANNELS: usize = 5 + MAX_INPUTS;
const VELOCITY: usize = 0;
const POSITION: usize = 1;

/// A kind of motion.
#[derive(Clone, Copy)]
enum Motion {
    /// There and back.
    Oscillation,
    /// Stops and starts.
    Dwells,
    /// Every channel anywhere in every sample.
    Jumps,
    /// There and back, with channels missing and sample periods doubled, zero or too long.
    Gaps,
    /// There and back, with a special value in one channel or the sample period after the other.
    SpecialValues,
}

const MOTIONS: [Motion; 8] = [
    Motion::Oscillation,
    Motion::Dwells,
    Motion::Oscillation,
    Motion::Gaps,
    Motion::Oscillation,
    Motion::Dwells,
    Motion::Jumps,
    Motion::SpecialValues,
];

/// The first `steps` calls of the sequence of a model.
#[must_use]
pub fn sequence<const CELLS: usize>(model: &Model<CELLS>, steps: usize) -> Vec<Call> {
    let mut generator = Generator::new(model);
    let mut calls = Vec::with_capacity(steps);
    for motion in MOTIONS.into_iter().cycle() {
        if calls.len() >= steps {
            break;
        }
        generator.segment(motion, &mut calls);
    }
    calls.truncate(steps);
    calls
}

struct Generator {
    random: ChaCha8Rng,
    /// Trained ranges of the channels of a measurement, `[-1, 1]` where the model does not read one.
    ranges: [[f32; 2]; CHANNELS],
    is_read: [bool; CHANNELS],
    output_limit: f32,
    channels: [f32; CHANNELS],
}

impl Generator {
    fn new<const CELLS: usize>(model: &Model<CELLS>) -> Self {
        let (mut ranges, mut is_read) = ([[-1.0, 1.0]; CHANNELS], [false; CHANNELS]);
        let mut others = 5..;
        for input in &model.inputs {
            let channel = match input.quantity {
                Quantity::Velocity => VELOCITY,
                Quantity::Position => POSITION,
                Quantity::Acceleration => 2,
                Quantity::Load => 3,
                Quantity::Temperature => 4,
                Quantity::Other(_) => others.next().unwrap_or(CHANNELS - 1),
            };
            ranges[channel] = [input.low, input.high];
            is_read[channel] = true;
        }
        let random = ChaCha8Rng::seed_from_u64(0);
        Self { random, ranges, is_read, output_limit: model.output_limit, channels: [0.0; CHANNELS] }
    }

    /// From 0 to 1.
    fn share(&mut self) -> f32 {
        (self.random.next_u32() >> 8) as f32 / 16_777_216.0
    }

    /// A power of ten with an exponent in the range.
    fn scale(&mut self, low: f32, high: f32) -> f32 {
        10f32.powf(low + (high - low) * self.share())
    }

    fn one_in(&mut self, count: u32) -> bool {
        self.random.next_u32().is_multiple_of(count)
    }

    /// A value in the range of a channel, widened by a quarter on either side.
    fn anywhere(&mut self, channel: usize) -> f32 {
        let [low, high] = self.ranges[channel];
        low + (1.5 * self.share() - 0.25) * (high - low)
    }

    fn special_value(&mut self) -> f32 {
        SPECIAL_VALUES[self.random.next_u32() as usize % SPECIAL_VALUES.len()]
    }

    /// Mostly limits that leave the friction as it is.
    fn limits(&mut self) -> [f32; 3] {
        let most = self.output_limit;
        let wide = [1.0, 2.0 * most, f32::MAX];
        match self.random.next_u32() % 8 {
            0 => [self.share(), most * self.scale(-2.0, 0.0), f32::MAX],
            1 => [1.0, 2.0 * most, most * self.scale(-1.0, 4.0)],
            2 => [self.special_value(), most, f32::MAX],
            3 => [0.9, self.special_value(), self.special_value()],
            _ => wide,
        }
    }

    fn segment(&mut self, motion: Motion, calls: &mut Vec<Call>) {
        let limits = self.limits();
        let period = self.scale(-5.0, 0.0);
        let [low, high] = self.ranges[VELOCITY];
        let top = (high - low) * self.scale(-7.0, 0.0);
        let turns_a_step = self.scale(-2.5, -0.5);
        let start = self.share();
        let mut is_reset = self.one_in(3);
        for channel in 0..CHANNELS {
            self.channels[channel] = self.anywhere(channel);
        }
        for step in 0..SEGMENT {
            let phase = start + turns_a_step * step as f32;
            let speed = top * (TAU * phase).sin();
            self.channels[VELOCITY] = match motion {
                Motion::Dwells if (phase as usize).is_multiple_of(2) => 0.0,
                Motion::Dwells if phase.fract() < 0.5 => top,
                _ => speed,
            };
            self.channels[POSITION] += self.channels[VELOCITY] * period;
            // The other channels wander.
            for channel in 2..CHANNELS {
                let target = self.anywhere(channel);
                self.channels[channel] += 0.05 * (target - self.channels[channel]);
            }
            let mut now = self.channels;
            let mut dt = period;
            match motion {
                Motion::Oscillation | Motion::Dwells => {}
                Motion::Jumps => now = std::array::from_fn(|channel| self.anywhere(channel)),
                Motion::Gaps => self.gap(&mut now, &mut dt),
                Motion::SpecialValues => {
                    let value = self.special_value();
                    match self.random.next_u32() as usize % (CHANNELS + 1) {
                        CHANNELS => dt = value,
                        channel => now[channel] = value,
                    }
                }
            }
            self.spoil_unread(&mut now);
            let [velocity, position, acceleration, load, temperature, other @ ..] = now;
            let measurement = Measurement { velocity, position, acceleration, load, temperature, other };
            calls.push(Call { reset: std::mem::take(&mut is_reset), limits, dt, measurement });
        }
    }

    /// A channel missing, or a sample period that is not the usual one, in every second sample.
    fn gap(&mut self, now: &mut [f32; CHANNELS], dt: &mut f32) {
        let channel = self.random.next_u32() as usize % CHANNELS;
        match self.random.next_u32() % 12 {
            0 => now[channel] = f32::NAN,
            1 => now[VELOCITY] = f32::INFINITY,
            2 => *dt = 0.0,
            3 => *dt *= 2.0,
            4 => *dt *= 50.0,
            5 => *dt = 1.5,
            _ => {}
        }
    }

    /// What a model does not read may be anything.
    fn spoil_unread(&mut self, now: &mut [f32; CHANNELS]) {
        for channel in 0..CHANNELS {
            if !self.is_read[channel] && self.one_in(16) {
                now[channel] = self.special_value();
            }
        }
    }
}
