//! Rust with the crate libm.
#![no_std]
#![no_main]

use frikan_firmware_harness::{entry, serve};
use frikan_firmware_peers::{Libm, Peer};

#[entry]
fn main() -> ! {
    serve::<Peer<Libm>>()
}
