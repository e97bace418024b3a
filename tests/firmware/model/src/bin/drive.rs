//! The smallest drive: decodes the image in flash, then compensates for ever. Its size is what a model costs.
#![no_std]
#![no_main]

use core::hint::black_box;

use frikan_firmware::CELLS;
use frikan_firmware_harness::{entry, flash};
use frikan_runtime::compensator::{Compensator, Limits};
use frikan_runtime::friction::Measurement;
use frikan_shared::image::image_bytes;

#[entry]
fn main() -> ! {
    let image = image_bytes(flash()).ok().and_then(|length| flash().get(..length)).unwrap_or_default();
    // Without a valid image compensation is off.
    let mut compensator =
        Compensator::<CELLS>::new(image, black_box(Limits::new(1.0, 1.0, 1.0).unwrap_or(Limits::OFF)));
    loop {
        let measurement = black_box(Measurement::default());
        black_box(compensator.step(&measurement, black_box(1.0e-3)));
    }
}
