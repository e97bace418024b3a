//! Steps the integer compensator of the table in flash through the counts that the host sends, and counts instructions.
#![no_std]
#![no_main]

use frikan_firmware::CountingDrive;
use frikan_firmware_harness::{entry, serve};

#[entry]
fn main() -> ! {
    serve::<CountingDrive>()
}
