//! The evaluator that every binary of this firmware runs: the friction image in flash, decoded once, then evaluated.
#![no_std]
#![forbid(unsafe_code)]

use frikan_firmware_harness::{Evaluator, Row};
use frikan_runtime::evaluate::evaluate;
use frikan_shared::image::{ImageError, decode};
use frikan_shared::model::Model;

/// Cells for which a drive has room.
pub const CELLS: usize = 128;

/// A drive that carries one joint's friction model.
pub struct Drive {
    model: Model<CELLS>,
}

impl Evaluator for Drive {
    fn decode(image: &'static [u8]) -> Result<Self, u32> {
        decode(image).map(|image| Self { model: image.model }).map_err(reason)
    }

    fn inputs(&self) -> usize {
        self.model.inputs.len()
    }

    fn evaluate(&mut self, row: &Row) -> f32 {
        evaluate(&self.model, row)
    }
}

/// The number by which the host knows a refusal.
fn reason(error: ImageError) -> u32 {
    match error {
        ImageError::Truncated => 1,
        ImageError::BadMagic => 2,
        ImageError::UnsupportedVersion(_) => 3,
        ImageError::TooLarge => 4,
        ImageError::TrailingBytes => 5,
        ImageError::CrcMismatch => 6,
        ImageError::Malformed => 7,
        ImageError::InvalidModel(_) => 8,
        _ => 9,
    }
}
