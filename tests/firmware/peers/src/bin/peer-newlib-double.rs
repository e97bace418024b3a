//! C with newlib's double functions.
#![no_std]
#![no_main]

use frikan_firmware_harness::{entry, serve};
use frikan_firmware_peers::{Peer, c::NewlibDouble};

#[entry]
fn main() -> ! {
    serve::<Peer<NewlibDouble>>()
}
