//! What a model costs on a target: instructions, flash, RAM, stack, decoding.

use frikan_runtime::integer::Units;
use frikan_shared::integer_table::REACH_BITS;
use frikan_trainer::compile::integers::steps::{INTEGER_CALL_WORDS, IntegerCall, integer_calls};
use frikan_trainer::compile::steps::sequence::sequence;
use frikan_trainer::compile::steps::{ANSWER_WORDS, CALL_WORDS, Call};
use frikan_trainer::emulator::{Answer, Emulator, Mode, Request};
use frikan_trainer::error::Result;

use crate::models::{self, TestModel};
use crate::vectors::{counts, one_input, space_filling};

/// Rows that are counted; the special values are among them.
pub const COUNTED_ROWS: usize = 4096;

/// Rows with which a model of the tests is counted: sweep, special values and random bits of a one-input model, a
/// space-filling set of others.
#[must_use]
pub fn counted_rows(model: &TestModel) -> Vec<f32> {
    match model.inputs.as_slice() {
        [input] => one_input(COUNTED_ROWS, input.high, 2),
        inputs => space_filling(COUNTED_ROWS, &inputs.iter().map(|input| input.high).collect::<Vec<_>>()),
    }
}

/// Counts the instructions of every one of [`counted_rows`].
///
/// # Errors
/// Those of [`Emulator::run`].
pub fn count(emulator: &Emulator, model: &TestModel) -> Result<Answer> {
    count_rows(emulator, &models::image(model), &counted_rows(model), model.inputs.len())
}

/// Counts the instructions of [`COUNTED_ROWS`] steps of the sequence by which `trainer verify` proves a model, on an emulator of
/// `emulate-step`.
///
/// # Errors
/// Those of [`Emulator::run`].
pub fn count_steps(emulator: &Emulator, model: &TestModel) -> Result<Answer> {
    let values: Vec<f32> = sequence(model, COUNTED_ROWS).iter().flat_map(Call::words).collect();
    emulator.run(&Request {
        image: &models::image(model),
        values: &values,
        inputs: CALL_WORDS,
        outputs: ANSWER_WORDS,
        mode: Mode::Count,
        floating_point_control: 0,
    })
}

/// Counts the instructions of an integer table, whose inputs are counts.
///
/// # Errors
/// Those of [`Emulator::run`].
pub fn count_integer(emulator: &Emulator, model: &TestModel) -> Result<Answer> {
    let rows: Vec<f32> =
        counts(COUNTED_ROWS, 1 << REACH_BITS, 2).into_iter().map(|count| f32::from_bits(count as u32)).collect();
    count_rows(emulator, &models::image(model), &rows, 1)
}

/// Counts of the velocity that [`count_integer_steps`] takes: Q3.12 and four values of the tests' table a count.
pub const UNITS: Units = Units { velocity: 1.0 / 4096.0, torque: 4.0e-3 };

/// Counts the instructions of the steps by which the integer compensator is proved, on an emulator of `emulate-integer-step`.
///
/// # Errors
/// Those of [`Emulator::run`].
///
/// # Panics
/// Where the law of the model is no integer table.
pub fn count_integer_steps(emulator: &Emulator, model: &TestModel) -> Result<Answer> {
    let calls = integer_calls(model, UNITS, COUNTED_ROWS).expect("an integer table");
    run_integer_steps(emulator, model, (UNITS, &calls), Mode::Count)
}

/// Runs the integer compensator through calls in counts of some units.
///
/// # Errors
/// Those of [`Emulator::run`].
pub fn run_integer_steps(
    emulator: &Emulator,
    model: &TestModel,
    (units, calls): (Units, &[IntegerCall]),
    mode: Mode,
) -> Result<Answer> {
    let values: Vec<f32> = calls.iter().flat_map(|call| call.words(units)).collect();
    let (image, inputs) = (&models::image(model), INTEGER_CALL_WORDS);
    emulator.run(&Request { image, values: &values, inputs, outputs: 1, mode, floating_point_control: 0 })
}

/// Counts the instructions of every row.
///
/// # Errors
/// Those of [`Emulator::run`].
pub fn count_rows(emulator: &Emulator, image: &[u8], values: &[f32], inputs: usize) -> Result<Answer> {
    emulator.run(&Request { image, values, inputs, outputs: 1, mode: Mode::Count, floating_point_control: 0 })
}
