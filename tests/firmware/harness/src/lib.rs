//! Runs an evaluator on an emulated drive and hands back, for every input, the output bits and, when asked, the
//! instructions that it took.
//!
//! The harness knows no model. The image stands in the emulated flash, between the linker symbols `_image_start` and
//! `_image_end` of the target's `memory.x`; the inputs come from the file `request.bin` and the outputs go to
//! `answer.bin`, both by semihosting and a chunk at a time, so that a vector may be longer than the memory of the part. A program that
//! runs in lockstep with the host exchanges words through the board's UART instead, and needs no semihosting.
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
#[allow(unsafe_code)]
mod uart;

pub use hardware::{flash, start_clock, write_flash};
pub use measure::{calibration, counted};
pub use protocol::Row;
pub use session::{Evaluator, serve};
pub use uart::Uart;

/// Marks the firmware's `main`.
#[cfg(target_arch = "arm")]
pub use cortex_m_rt::entry;
/// Marks the firmware's `main`.
#[cfg(target_arch = "riscv32")]
pub use riscv_rt::entry;
