//! Start-up and nothing else: what the sizes of the other programs are measured against.
#![no_std]
#![no_main]

use core::hint::black_box;

use frikan_firmware_harness::entry;

#[entry]
fn main() -> ! {
    loop {
        black_box(0.0_f32);
    }
}
