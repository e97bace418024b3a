//! Law and effects together, one sample after the other: what the compensator feeds forward and what a prediction replays.

use frikan_shared::effect::{Effect, MAX_EFFECTS};
use frikan_shared::elementary;
use frikan_shared::model::{Input, MAX_INPUTS, Model, RigidBody};
use frikan_shared::units::Quantity;

use crate::effects::{Motion, State, contribution, frictional_lag};
use crate::evaluate::{evaluate, held, limited};

/// What the drive knows of the joint in one sample, in SI. Channels that the model does not use may hold anything.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measurement {
    /// Velocity, measured or of the reference, rad/s.
    pub velocity: f32,
    /// Position, rad.
    pub position: f32,
    /// Acceleration, rad/s^2.
    pub acceleration: f32,
    /// Torque transmitted by the gear, N m.
    pub load: f32,
    /// Temperature, degC.
    pub temperature: f32,
    /// Channels without a standard quantity, in the order of the model's inputs.
    pub other: [f32; MAX_INPUTS],
}

impl Measurement {
    /// The channels that `inputs` name, in their order; the rest is 0.
    #[must_use]
    pub fn channels(&self, inputs: &[Input]) -> [f32; MAX_INPUTS] {
        let mut channels = [0.0; MAX_INPUTS];
        let mut others = self.other.iter();
        for (channel, input) in channels.iter_mut().zip(inputs) {
            *channel = match input.quantity {
                Quantity::Velocity => self.velocity,
                Quantity::Position => self.position,
                Quantity::Acceleration => self.acceleration,
                Quantity::Load => self.load,
                Quantity::Temperature => self.temperature,
                Quantity::Other(_) => others.next().copied().unwrap_or(0.0),
            };
        }
        channels
    }
}

/// Friction of one sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Friction {
    /// Law and effects, within the model's output limit, in the unit of the model's output.
    pub torque: f32,
    /// What the effects add to the link's position against the motor's, rad.
    pub position: f32,
}

/// The memory of a model's effects.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionState {
    states: [State; MAX_EFFECTS],
}

impl FrictionState {
    /// At rest, cold, nothing wound up.
    #[must_use]
    pub fn new(effects: &[Effect]) -> Self {
        let mut states = [State::None; MAX_EFFECTS];
        for (state, effect) in states.iter_mut().zip(effects) {
            *state = State::new(effect);
        }
        Self { states }
    }

    /// At rest, nothing wound up, and as warm as `effects` are after a rest of so many seconds; cold where the rest is not
    /// positive, for then nothing is known of it.
    #[must_use]
    pub fn after_rest(&self, effects: &[Effect], rest: f32) -> Self {
        let mut after = Self::new(effects);
        if rest > 0.0 {
            for ((state, effect), before) in after.states.iter_mut().zip(effects).zip(&self.states) {
                *state = before.after_rest(effect, rest);
            }
        }
        after
    }

    /// Advances by `dt` seconds and returns the friction at the end of them.
    ///
    /// NaN in a channel that the model reads gives no friction and leaves the memory as it was; `dt` must be finite and
    /// not negative, and counts as 0 otherwise.
    #[must_use]
    pub fn step<const CELLS: usize>(&mut self, model: &Model<CELLS>, measurement: &Measurement, dt: f32) -> Friction {
        let mut channels = measurement.channels(&model.inputs);
        if channels.iter().any(|channel| channel.is_nan()) {
            return Friction::default();
        }
        let dt = if dt > 0.0 && dt.is_finite() { dt } else { 0.0 };
        let mut motion = Motion::new(&model.inputs, &held(&model.inputs, &channels), measurement.position, dt);
        for (effect, state) in model.effects.iter().zip(&mut self.states) {
            if let (Effect::FrictionalLag { time_constant }, State::Lag(lag)) = (effect, state) {
                let lagged = frictional_lag::step(*time_constant, lag, &motion);
                for (channel, input) in channels.iter_mut().zip(&model.inputs) {
                    *channel = if input.quantity == Quantity::Velocity { lagged } else { *channel };
                }
            }
        }
        motion.law_torque = evaluate(model, &channels);
        let mut friction = Friction { torque: motion.law_torque, position: 0.0 };
        for (effect, state) in model.effects.iter().zip(&mut self.states) {
            let added = contribution(effect, state, &motion, &model.cells);
            friction.torque += added.torque;
            friction.position += added.position;
        }
        friction.torque = limited(friction.torque, model.output_limit);
        friction
    }
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
