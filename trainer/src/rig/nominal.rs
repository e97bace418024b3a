//! The model of a joint whose friction is known: what a perfect fit of its static law would give.

use frikan_runtime::shared::expression::{Operation, Program};
use frikan_runtime::shared::model::{Input, Law, Model, RigidBody};
use frikan_runtime::shared::pool::Pool;
use frikan_runtime::shared::units::{Quantity, Unit};

use crate::plant::Friction;

/// Slope of the smooth sign, s/rad: `tanh(192 v)` is at 99.9 % at 20 mrad/s.
const SIGN_SLOPE: f32 = 192.0;
/// Largest speed of the model, rad/s.
const TOP_SPEED: f32 = 20.0;

/// `(coulomb + stribeck exp(-(|v| / stribeck velocity)^exponent)) tanh(192 v) + viscous v`, N m at rad/s. `None` of friction that depends on
/// the torques at the gear, and where a parameter is not one that an image may hold.
#[must_use]
pub fn nominal_model<const CELLS: usize>(friction: &Friction) -> Option<Model<CELLS>> {
    if friction.reads_load() {
        return None;
    }
    let viscous = friction.viscous_nm_s_rad as f32;
    let slope = 1.0 / friction.stribeck_velocity_rad_s as f32;
    let exponent = friction.stribeck_exponent as f32;
    let exponential = [Operation::ScaledMagnitude(0, -slope)];
    let other = [Operation::ScaledMagnitude(0, slope), Operation::PowerOf(exponent), Operation::Negate];
    let decline = if exponent == 1.0 { &exponential[..] } else { &other[..] };
    let sliding = [
        Operation::Exp,
        Operation::Scale(friction.stribeck_torque_nm as f32),
        Operation::Offset(friction.coulomb_torque_nm as f32),
        Operation::ScaledInput(0, SIGN_SLOPE),
        Operation::Tanh,
        Operation::Multiply,
        Operation::AddScaledInput(0, viscous),
    ];
    let velocity =
        Input { quantity: Quantity::Velocity, unit: Unit::RadianPerSecond, low: -TOP_SPEED, high: TOP_SPEED };
    let model = Model {
        inputs: [velocity].into_iter().collect(),
        output_unit: Unit::NewtonMetre,
        output_limit: friction.dry_level(0.0) as f32 + viscous * TOP_SPEED,
        rigid_body: RigidBody::default(),
        law: Law::Expression(Program { operations: decline.iter().copied().chain(sliding).collect() }),
        effects: [].into_iter().collect(),
        cells: Pool::new(),
    };
    model.validate().is_ok().then_some(model)
}
