//! The smallest drive: decodes the image in flash, then evaluates for ever. Its size is what a model costs.
#![no_std]
#![no_main]

use core::hint::black_box;

use frikan_firmware::Drive;
use frikan_firmware_harness::{Evaluator, entry, flash};
use frikan_shared::image::image_bytes;

#[entry]
fn main() -> ! {
    let image = image_bytes(flash()).ok().and_then(|length| flash().get(..length));
    let mut drive = image.and_then(|image| Drive::decode(image).ok());
    loop {
        let row = black_box([0.0; 4]);
        // Without a valid model compensation is off.
        black_box(drive.as_mut().map_or(0.0, |drive| drive.evaluate(&row)));
    }
}
