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

/// Counts the instructions of [`COUNTED_ROWS`] supervised steps on an emulator of `emulate-supervised`: a sine behind its reference, with rests; `learns` says
/// whether the drive adapts to the joint.
///
/// # Errors
/// Those of [`Emulator::run`].
pub fn count_supervised(emulator: &Emulator, model: &TestModel, learns: bool) -> Result<Answer> {
    let row = |sample: usize| {
        let time = sample as f32 * 1.0e-3;
        let (reference, position) =
            if sample / 900 % 4 == 3 { (0.0, 0.4) } else { (1.2 * (3.0 * time).sin(), 0.4 - 0.4 * (3.0 * time).cos()) };
        let velocity = reference + 0.003 * (211.0 * time).sin();
        [f32::from_bits(learns.into()), 1.0e-3, velocity, position, reference, 15.0 * reference.signum()]
    };
    let rows: Vec<[f32; 6]> = (0..COUNTED_ROWS).map(row).collect();
    count_rows(emulator, &models::image(model), rows.as_flattened(), 6)
}

/// Counts the instructions of every row.
///
/// # Errors
/// Those of [`Emulator::run`].
pub fn count_rows(emulator: &Emulator, image: &[u8], values: &[f32], inputs: usize) -> Result<Answer> {
    emulator.run(&Request { image, values, inputs, outputs: 1, mode: Mode::Count, floating_point_control: 0 })
}

/// By how much a figure may grow beyond that of docs/drive-cost.md before somebody has to look: it is then written anew.
const GROWTH: f64 = 0.05;

/// A row of docs/drive-cost.md.
#[derive(Clone, Debug)]
pub struct Documented {
    name: String,
    figures: Vec<(String, u64)>,
}

impl Documented {
    /// The row that begins with `row` in the section of this heading.
    ///
    /// # Panics
    /// Where there is none.
    #[must_use]
    pub fn of(section: &str, row: &str) -> Self {
        let page = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/drive-cost.md"))
            .expect("the page is in the checkout");
        let section = page.split("\n## ").find(|text| text.starts_with(&format!("{section}\n"))).expect(section);
        let cells =
            |line: &str| line.trim_matches('|').split('|').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
        let mut lines = section.lines().filter(|line| line.starts_with('|')).map(cells);
        let head = lines.next().expect("a section has a table");
        let line = lines.find(|cells| cells[0] == row).expect(row);
        // Of a range, the most.
        let figure = |cell: &str| cell.rsplit('-').next().and_then(|number| number.parse().ok());
        let figures = head.into_iter().zip(&line).filter_map(|(name, cell)| Some((name, figure(cell)?))).collect();
        Self { name: format!("{section}, {row}", section = section.lines().next().unwrap_or_default()), figures }
    }

    /// What the page has in a column.
    ///
    /// # Panics
    /// Where the row has no such figure.
    #[must_use]
    pub fn figure(&self, column: &str) -> u64 {
        self.figures.iter().find(|(name, _)| name == column).expect(column).1
    }

    /// That what is measured has not grown beyond the page.
    ///
    /// # Panics
    /// Where it has.
    pub fn holds(&self, column: &str, measured: u64) {
        let figure = self.figure(column);
        let name = &self.name;
        assert!(
            measured as f64 <= (1.0 + GROWTH) * figure as f64,
            "{name}: {measured} {column}, {figure} in docs/drive-cost.md; `tests/pages.sh drive-cost` writes it anew"
        );
    }
}
