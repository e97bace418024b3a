//! Models for the tests of this crate.

use frikan_shared::effect::Effect;
use frikan_shared::expression::{Operation, Program};
use frikan_shared::image::{Image, encode};
use frikan_shared::model::{Input, Law, Model, Provenance, RigidBody};
use frikan_shared::pool::Pool;
use frikan_shared::units::{Quantity, Unit};
use std::vec::Vec;

pub(crate) type TestModel = Model<16>;

/// `coulomb tanh(50 v)` with all standard channels, and `effects`.
pub(crate) fn coulomb_model(coulomb: f32, effects: &[Effect]) -> TestModel {
    let channel = |quantity, unit| Input { quantity, unit, low: -2.0, high: 2.0 };
    let inputs = [
        channel(Quantity::Velocity, Unit::RadianPerSecond),
        channel(Quantity::Position, Unit::Radian),
        channel(Quantity::Load, Unit::NewtonMetre),
        channel(Quantity::Temperature, Unit::Celsius),
    ];
    let operations = [Operation::ScaledInput(0, 50.0), Operation::Tanh, Operation::Scale(coulomb)];
    let model = TestModel {
        inputs: heapless::Vec::from_slice(&inputs).unwrap(),
        output_unit: Unit::NewtonMetre,
        output_limit: 1000.0,
        rigid_body: RigidBody::default(),
        law: Law::Expression(Program { operations: heapless::Vec::from_slice(&operations).unwrap() }),
        effects: heapless::Vec::from_slice(effects).unwrap(),
        cells: Pool::new(),
    };
    model.validate().unwrap();
    model
}

/// The image of a model.
pub(crate) fn image_of(model: TestModel) -> Vec<u8> {
    let mut buffer = [0; 4096];
    encode(&Image { provenance: Provenance::default(), model }, &mut buffer).unwrap().to_vec()
}
