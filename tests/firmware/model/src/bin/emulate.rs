//! Evaluates the static law of the image in flash on the rows that the host sends, and counts.
#![no_std]
#![no_main]

use frikan_firmware::StaticLaw;
use frikan_firmware_harness::{entry, serve};

#[entry]
fn main() -> ! {
    serve::<StaticLaw>()
}
