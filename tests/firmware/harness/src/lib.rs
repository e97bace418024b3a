//! Runs an evaluator on an emulated drive and hands back, for every input, the output bits and, when asked, the
//! instructions that it took.
//!
//! The harness knows no model. The image stands in the emulated flash, between the linker symbols `_image_start` and
//! `_image_end` of the target's `memory.x`; the inputs come from the file `request.bin` and the outputs go to
//! `answer.bin`, both by semihosting and a chunk at a time, so that a vector may be longer than the memory of the part.
#![no_std]
#![deny(unsafe_code)]
#![warn(missing_docs)]

#[allow(unsafe_code)]
mod hardware;
mod measure;
mod protocol;
#[allow(unsafe_code)]
mod semihosting;
mod session;

pub use hardware::flash;
pub use protocol::Row;
pub use session::{Evaluator, serve};

/// Marks the firmware's `main`.
#[cfg(target_arch = "arm")]
pub use cortex_m_rt::entry;
/// Marks the firmware's `main`.
#[cfg(target_arch = "riscv32")]
pub use riscv_rt::entry;
