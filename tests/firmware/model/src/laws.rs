//! Laws alone, decoded: without limits and without memory.

use frikan_firmware_harness::{Evaluator, Row};
use frikan_runtime::evaluate::evaluate;
use frikan_runtime::integer_table::evaluate_integer;
use frikan_shared::image::decode;
use frikan_shared::integer_table::IntegerTable;
use frikan_shared::model::{Law, MAX_INPUTS, Model};
use frikan_shared::pool::Pool;

use crate::{CELLS, reason};

/// The static law of an image: a row holds the inputs of the model.
pub struct StaticLaw {
    model: Model<CELLS>,
}

impl Evaluator for StaticLaw {
    fn decode(image: &'static [u8]) -> Result<Self, u32> {
        decode(image).map(|image| Self { model: image.model }).map_err(reason)
    }

    fn inputs(&self) -> usize {
        self.model.inputs.len()
    }

    fn evaluate(&mut self, row: &Row) -> f32 {
        // A row is longer than the model's inputs; the rest of it is not looked at.
        row.first_chunk::<MAX_INPUTS>().map_or(0.0, |inputs| evaluate(&self.model, inputs))
    }
}

/// A drive without floating-point unit: input and output are counts, in the bits of the row and of the answer.
#[repr(C)]
pub struct IntegerDrive {
    table: IntegerTable,
    cells: Pool<CELLS>,
}

impl Evaluator for IntegerDrive {
    fn decode(image: &'static [u8]) -> Result<Self, u32> {
        let model = decode::<CELLS>(image).map_err(reason)?.model;
        match model.law {
            Law::IntegerTable(table) => Ok(Self { table, cells: model.cells }),
            _ => Err(NOT_AN_INTEGER_TABLE),
        }
    }

    fn inputs(&self) -> usize {
        1
    }

    fn evaluate(&mut self, row: &Row) -> f32 {
        let [steps, ..] = *row;
        f32::from_bits(evaluate_integer(&self.table, &self.cells, steps.to_bits() as i32) as u32)
    }
}

/// The refusal of an image whose law is of another kind.
const NOT_AN_INTEGER_TABLE: u32 = 10;
