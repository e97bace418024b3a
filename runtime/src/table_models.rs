//! The commonest models, a table alone and a table with presliding, each in a straight line that keeps to few registers. What they compute is
//! what [`crate::friction`] computes of every model.

use frikan_shared::effect::{Effect, Element};
use frikan_shared::model::{Input, Law, Model};
use frikan_shared::table::Geometric;
use frikan_shared::units::Quantity;

use crate::bounds::within;
use crate::effects::{Motion, presliding, travel};
use crate::friction::{Friction, FrictionState, Measurement};
use crate::laws::evaluate::held;
use crate::laws::table::geometric_value;
use crate::usable::{Usable, finite, not_zero};

/// The friction of a table of the velocity, some number where it is not usable, without effects; `None` for any other model. `is_step` is negative where the
/// sample period is one.
#[inline(always)]
pub(crate) fn table_alone<const CELLS: usize>(
    model: &Model<CELLS>,
    measurement: &Measurement,
    is_step: i32,
) -> Option<Friction> {
    let (Law::Geometric(layout), [input], []) = (&model.law, &model.inputs[..], &model.effects[..]) else {
        return None;
    };
    if input.quantity != Quantity::Velocity {
        return None;
    }
    let velocity = measurement.velocity;
    let usable = Usable::where_negative(finite(velocity) & is_step);
    // Validation has proved the values of the table finite and within the limit, for any velocity. At rest there is no friction of it.
    let moves = (not_zero(velocity) >> 31) as u32;
    let torque = f32::from_bits(geometric_value(layout, &model.cells, velocity).to_bits() & moves);
    Some(Friction { torque, position: 0.0, usable })
}

/// A table of the velocity with presliding, by the position where it is read.
pub(crate) struct TableWithPresliding<'a, const CELLS: usize> {
    model: &'a Model<CELLS>,
    layout: &'a Geometric,
    velocity: &'a Input,
    reads_position: bool,
    smoothing_velocity: f32,
    elements: &'a [Element],
}

impl<'a, const CELLS: usize> TableWithPresliding<'a, CELLS> {
    /// `None` where the model is another.
    #[inline(always)]
    pub(crate) fn of(model: &'a Model<CELLS>) -> Option<Self> {
        let (Law::Geometric(layout), [velocity, others @ ..], [Effect::Presliding { smoothing_velocity, elements }]) =
            (&model.law, &model.inputs[..], &model.effects[..])
        else {
            return None;
        };
        let reads_position = match others {
            [] => false,
            [other] if other.quantity == Quantity::Position => true,
            _ => return None,
        };
        // Presliding reads the velocity; no quantity occurs twice.
        Some(Self { model, layout, velocity, reads_position, smoothing_velocity: *smoothing_velocity, elements })
    }

    /// The friction of a sample, some number where it is not usable; `is_step` is negative where the sample period `dt` is one.
    #[inline(always)]
    pub(crate) fn step(&self, state: &mut FrictionState, measurement: &Measurement, dt: f32, is_step: i32) -> Friction {
        let Measurement { velocity: channel, position, .. } = *measurement;
        let velocity = held(self.velocity, channel);
        let is_usable = is_step & finite(channel);
        let (usable, travel) = if self.reads_position {
            let usable = Usable::where_negative(is_usable & finite(position));
            (usable, travel::step(&mut state.travel, position, usable))
        } else {
            (Usable::where_negative(is_usable), velocity * dt)
        };
        let motion = Motion { velocity, travel, usable, ..Motion::default() };
        let [memory, ..] = &mut state.memories;
        let added = presliding::step(self.smoothing_velocity, self.elements, memory, &motion);
        // Law and elements are bounded by their validation: no sum of theirs is infinite or NaN.
        let torque =
            within(geometric_value(self.layout, &self.model.cells, channel) + added.torque, self.model.output_limit);
        Friction { torque, position: 0.0, usable }
    }
}
