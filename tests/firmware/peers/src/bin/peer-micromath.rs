//! Rust with the crate micromath.
#![no_std]
#![no_main]

use frikan_firmware_harness::{entry, serve};
use frikan_firmware_peers::{Micromath, Peer};

#[entry]
fn main() -> ! {
    serve::<Peer<Micromath>>()
}
