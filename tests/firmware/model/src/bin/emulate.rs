//! Evaluates the image in flash on the rows that the host sends.
#![no_std]
#![no_main]

use frikan_firmware_harness::{Evaluator, Row, entry, serve};

struct Drive {
    gain: f32,
}

impl Evaluator for Drive {
    fn decode(image: &'static [u8]) -> Result<Self, u32> {
        let bits = image.first_chunk().ok_or(1_u32)?;
        Ok(Self { gain: f32::from_le_bytes(*bits) })
    }

    fn inputs(&self) -> usize {
        1
    }

    fn evaluate(&mut self, row: &Row) -> f32 {
        self.gain * row[0] + 1.0
    }
}

#[entry]
fn main() -> ! {
    serve::<Drive>()
}
