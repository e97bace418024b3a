//! C with newlib's float functions.
#![no_std]
#![no_main]

use frikan_firmware_harness::{entry, serve};
use frikan_firmware_peers::{Peer, c::NewlibFloat};

#[entry]
fn main() -> ! {
    serve::<Peer<NewlibFloat>>()
}
