//! Runs an image on an emulated drive: the firmware is built for the target, QEMU carries it and the very image file,
//! rows go in, output bits and instruction counts come back, all at once or in lockstep with a joint that the host moves.
//!
//! Knows files, processes and the firmware folder; knows nothing of models, recordings or commands.

mod elf;
mod firmware;
mod lockstep;
mod protocol;
mod qemu;
mod target;

pub use elf::{Footprint, footprint, forbidden_symbols};
pub use firmware::{FIRMWARE_VARIABLE, Firmware, firmware_folder};
pub use lockstep::Lockstep;
pub use protocol::{Answer, MAX_INPUTS, Mode, Request};
pub use target::Target;

use std::path::PathBuf;

use crate::error::Result;

/// Firmware for one target, built and ready to run.
#[derive(Clone, Debug)]
pub struct Emulator {
    target: Target,
    elf: PathBuf,
    image_window: elf::Window,
}

impl Emulator {
    /// The emulator of a target by its name, such as `cortex-m4f`, with the firmware that evaluates Frikan images.
    ///
    /// Builds the firmware when it is not up to date.
    ///
    /// # Errors
    /// `FRK-U004` for a name that is no target; `FRK-I004` to `FRK-I007` where firmware, compiler or emulator are
    /// missing or the build fails.
    pub fn new(target: &str) -> Result<Self> {
        Self::with_binary(&Firmware::find()?, target, "emulate")
    }

    /// As [`Emulator::new`], with another binary of the firmware folder that speaks the same protocol.
    ///
    /// # Errors
    /// As [`Emulator::new`].
    pub fn with_binary(firmware: &Firmware, target: &str, binary: &str) -> Result<Self> {
        let target = firmware.target(target)?;
        let elf = firmware.build(&target, binary)?;
        Self::with_elf(target, elf)
    }

    /// As [`Emulator::with_binary`], with a program that somebody else linked, such as one in C.
    ///
    /// # Errors
    /// `FRK-I004` where the emulator is missing, `FRK-I007` where the program keeps no flash for an image.
    pub fn with_elf(target: Target, elf: PathBuf) -> Result<Self> {
        qemu::check_installed(&target)?;
        let image_window = elf::image_window(&elf)?;
        Ok(Self { target, elf, image_window })
    }

    /// The target.
    #[must_use]
    pub fn target(&self) -> &Target {
        &self.target
    }

    /// Evaluates every row of `request` on the target.
    ///
    /// # Errors
    /// `FRK-I008` where the emulation fails, the firmware refuses the image, or the image exceeds the flash window.
    pub fn run(&self, request: &Request<'_>) -> Result<Answer> {
        qemu::run(&self.target, &self.elf, self.image_window, request)
    }

    /// Flash and RAM that decoding and evaluating take on the target, beyond a program that does nothing.
    ///
    /// Flash is code and constants of the smallest firmware that carries a model; RAM is its data and the decoded model.
    ///
    /// # Errors
    /// `FRK-I007` where the build fails.
    pub fn footprint(&self) -> Result<Footprint> {
        let firmware = Firmware::find()?;
        let drive = footprint(&firmware.build(&self.target, "drive")?)?;
        let bare = footprint(&firmware.build(&self.target, "bare")?)?;
        Ok(drive.beyond(bare))
    }
}
