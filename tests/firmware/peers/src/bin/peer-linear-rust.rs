//! Rust with a linear table.
#![no_std]
#![no_main]

use frikan_firmware_harness::{entry, serve};
use frikan_firmware_peers::{Peer, linear::LinearTable};

#[entry]
fn main() -> ! {
    serve::<Peer<LinearTable>>()
}
