//! The harness alone, whose size is taken off the others.
#![no_std]
#![no_main]

use frikan_firmware_harness::{entry, serve};
use frikan_firmware_peers::{Nothing, Peer};

#[entry]
fn main() -> ! {
    serve::<Peer<Nothing>>()
}
