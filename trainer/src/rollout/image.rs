//! The friction of an image, law and effects, in a simulation.

use frikan_runtime::evaluate::evaluate;
use frikan_runtime::friction::{FrictionState, Measurement};
use frikan_shared::model::MAX_INPUTS;
use frikan_shared::units::Quantity;

use super::resistance::{Instant, Levels, Resistance, Split};
use crate::compile::host_model::HostModel;
use crate::error::{Error, Result, codes};

/// Friction of a model with the memory of its effects.
pub struct ImageFriction<'a> {
    model: &'a HostModel,
    split: Split,
    state: FrictionState,
}

impl<'a> ImageFriction<'a> {
    /// The friction of a model.
    ///
    /// # Errors
    /// `FRK-D009` where the model reads a channel that no simulation knows.
    pub fn new(model: &'a HostModel) -> Result<Self> {
        for input in &model.inputs {
            if let Quantity::Other(name) = &input.quantity {
                let message = format!("the model reads `{name}`, which a simulation of the joint does not have");
                return Err(Error::new(&codes::MISSING_COLUMN, message).in_column(name.as_str()));
            }
        }
        let top = f64::from(model.top_speed().unwrap_or(1.0));
        let middle = |quantity: &Quantity| {
            let input = model.inputs.iter().find(|input| input.quantity == *quantity);
            input.map_or(0.0, |input| 0.5 * f64::from(input.low + input.high))
        };
        let at = Instant {
            position: middle(&Quantity::Position),
            load: middle(&Quantity::Load),
            temperature: middle(&Quantity::Temperature),
            ..Instant::default()
        };
        let split = Split::of(|velocity| law(model, &Instant { velocity, ..at }), top);
        Ok(Self { model, split, state: FrictionState::new() })
    }

    fn effects(&mut self, at: &Instant, step_s: f64) -> f64 {
        if self.model.effects.is_empty() {
            return 0.0;
        }
        let friction = self.state.step(self.model, &measurement(at), step_s as f32);
        f64::from(friction.torque) - law(self.model, at)
    }
}

impl Resistance for ImageFriction<'_> {
    fn levels(&mut self, at: &Instant, step_s: f64) -> Levels {
        let effects = self.effects(at, step_s);
        let mut levels = self.split.levels(|velocity| law(self.model, &Instant { velocity, ..*at }), at.velocity);
        // What effects add is a torque along the positive direction: more friction one way is less the other.
        levels.dry.forward = (levels.dry.forward + effects).max(0.0);
        levels.dry.backward = (levels.dry.backward - effects).max(0.0);
        levels
    }

    fn restart(&mut self) {
        self.state = self.state.after_rest(&self.model.effects, f32::MIN_POSITIVE);
    }
}

fn measurement(at: &Instant) -> Measurement {
    Measurement {
        velocity: at.velocity as f32,
        position: at.position as f32,
        load: at.load as f32,
        temperature: at.temperature as f32,
        acceleration: 0.0,
        ..Measurement::default()
    }
}

/// The static law of a model at an instant.
#[must_use]
pub fn law(model: &HostModel, at: &Instant) -> f64 {
    let channels: [f32; MAX_INPUTS] = measurement(at).channels(&model.inputs);
    f64::from(evaluate(model, &channels))
}
