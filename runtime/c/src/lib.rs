//! The compensator for firmware in C. `include/frikan.h` is generated from `types.rs`, `ffi.rs`, `admission.rs`, `slots.rs`, `flash.rs`, `supervised.rs`,
//! `keep.rs`, `integers.rs` and `presliding.rs`; these but the first, `memory.rs` and `model.rs` are the only files with `unsafe`.
//!
//! The static library for a target:
//!
//! ```text
//! cargo rustc -p frikan-c --profile drive --crate-type staticlib --target thumbv7em-none-eabihf
//! ```
//!
//! `example/` is a firmware for a Cortex-M4F that uses it. On a host the library links the standard library, for tests.
#![no_std]

#[cfg(not(target_os = "none"))]
extern crate std;

#[allow(unsafe_code)]
pub mod admission;
#[allow(unsafe_code)]
pub mod ffi;
#[cfg(feature = "slots")]
#[allow(unsafe_code)]
pub mod flash;
#[cfg(feature = "integer")]
#[allow(unsafe_code)]
pub mod integers;
#[cfg(any(feature = "models", feature = "supervised"))]
#[allow(unsafe_code)]
pub mod keep;
#[allow(unsafe_code)]
mod memory;
#[allow(unsafe_code)]
mod model;
#[cfg(feature = "integer")]
#[allow(unsafe_code)]
pub mod presliding;
#[cfg(feature = "slots")]
#[allow(unsafe_code)]
pub mod slots;
#[cfg(feature = "supervised")]
#[allow(unsafe_code)]
pub mod supervised;
pub mod types;

/// No panic can be reached, and linking with `--gc-sections` leaves nothing of this handler.
#[cfg(target_os = "none")]
#[panic_handler]
fn panic(_: &core::panic::PanicInfo<'_>) -> ! {
    loop {}
}
