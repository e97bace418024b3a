//! Evaluates the integer table in flash on the counts that the host sends.
#![no_std]
#![no_main]

use frikan_firmware::IntegerDrive;
use frikan_firmware_harness::{entry, serve};

#[entry]
fn main() -> ! {
    serve::<IntegerDrive>()
}
