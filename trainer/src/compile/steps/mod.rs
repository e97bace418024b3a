//! Bit-for-bit comparison of the compensator's step, effects, memory and limits included, with the trainer's reference.
//!
//! [`sequence::sequence`] says what is stepped through, [`mod@reference`] what must come out, [`compare`] whether it does, here or, from the
//! answers of an emulated target, with [`compare_answers`].

pub mod effects;
pub mod reference;
pub mod sequence;

use frikan_runtime::compensator::{Compensation, Compensator, Limits, Status};
use frikan_runtime::friction::Measurement;
use frikan_shared::model::Model;

use super::verify::Comparison;
use reference::Reference;

/// Fewest steps of a comparison that counts as a proof.
pub const LEAST_STEPS: usize = 100_000;

/// Words of a call as an emulated drive takes them.
pub const CALL_WORDS: usize = 14;

/// Words of an answer as an emulated drive gives them.
pub const ANSWER_WORDS: usize = 3;

/// Largest position that the firmware of a comparison allows, rad: effects exceed it, but not always.
pub const POSITION_LIMIT: f32 = 0.4;

/// One call of the step, with what the firmware does before it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Call {
    /// Whether the compensator is reset.
    pub reset: bool,
    /// The limits set: gain, torque in the unit of the model's output, slew in that unit a second.
    pub limits: [f32; 3],
    /// Sample period, s.
    pub dt: f32,
    /// The sample.
    pub measurement: Measurement,
}

impl Call {
    /// The words of `tests/firmware/model/src/drive.rs`.
    #[must_use]
    pub fn words(&self) -> [f32; CALL_WORDS] {
        let Measurement { velocity, position, acceleration, load, temperature, other: [a, b, c, d] } = self.measurement;
        let [gain, torque, slew] = self.limits;
        let reset = f32::from_bits(u32::from(self.reset));
        [reset, gain, torque, slew, self.dt, velocity, position, acceleration, load, temperature, a, b, c, d]
    }
}

/// What a step answers, as bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Answer {
    /// Of the torque, in the unit of the model's output.
    pub torque: u32,
    /// Of the position of the link against the motor, rad or m.
    pub position: u32,
    /// 0 active, 1 not finite, 2 no model.
    pub status: u32,
}

impl Answer {
    /// A torque and a position that are a compensation or, because of a channel that is not finite, none.
    #[must_use]
    pub fn new(torque: f32, position: f32, is_active: bool) -> Self {
        Self { torque: torque.to_bits(), position: position.to_bits(), status: u32::from(!is_active) }
    }

    /// The answer of an emulated drive.
    #[must_use]
    pub fn from_words([torque, position, status]: [f32; ANSWER_WORDS]) -> Self {
        Self { torque: torque.to_bits(), position: position.to_bits(), status: status.to_bits() }
    }
}

impl From<Compensation> for Answer {
    fn from(Compensation { torque, position, status }: Compensation) -> Self {
        let status = match status {
            Status::Active => 0,
            Status::NotFinite => 1,
            Status::NoModel(_) => 2,
        };
        Self { torque: torque.to_bits(), position: position.to_bits(), status }
    }
}

/// A step at which answer and reference differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepDifference {
    /// Number of the step, from 0.
    pub step: u64,
    /// The call.
    pub call: Call,
    /// What came out.
    pub computed: Answer,
    /// What the reference gives.
    pub expected: Answer,
}

/// Compares the answers that a drive gives to `calls`, one after the other from its start, with those of the reference.
///
/// A call without an answer counts as compared and not equal.
#[must_use]
pub fn compare_answers<const CELLS: usize>(
    model: &Model<CELLS>,
    calls: &[Call],
    answers: impl IntoIterator<Item = Answer>,
) -> Comparison<StepDifference> {
    let mut reference = Reference::new(model, effects::added);
    let difference = |step, call: &Call, computed, expected| StepDifference { step, call: *call, computed, expected };
    Comparison::of_answers(calls, answers, |call| reference.step(call), difference)
}

/// The answer of the runtime's compensator to a call.
pub fn step<const CELLS: usize>(compensator: &mut Compensator<CELLS>, call: &Call) -> Answer {
    if call.reset {
        compensator.reset();
    }
    let [gain, torque, slew] = call.limits;
    // Limits that are refused leave those before in force.
    if let Ok(limits) = Limits::new(gain, torque, slew).and_then(|limits| limits.with_position(POSITION_LIMIT)) {
        compensator.set_limits(limits);
    }
    compensator.step(&call.measurement, call.dt).into()
}

/// Compares the runtime's compensator over `calls`.
#[must_use]
pub fn compare<const CELLS: usize>(model: &Model<CELLS>, calls: &[Call]) -> Comparison<StepDifference> {
    let mut compensator = Compensator::with_model(Ok(model.clone()), Limits::OFF);
    compare_answers(model, calls, calls.iter().map(|call| step(&mut compensator, call)))
}
