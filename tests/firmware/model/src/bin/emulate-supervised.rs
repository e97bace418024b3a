//! Steps the supervised compensator of the image in flash through the samples that the host sends, and counts.
#![no_std]
#![no_main]

use frikan_firmware::WatchedDrive;
use frikan_firmware_harness::{entry, serve};

#[entry]
fn main() -> ! {
    serve::<WatchedDrive>()
}
