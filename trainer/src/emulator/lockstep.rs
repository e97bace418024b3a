//! A program that runs on an emulated drive in lockstep with the host: words over the board's UART, which QEMU carries over a socket.
//!
//! The firmware's side is `tests/firmware/model/src/bin/loop.rs`.

use std::io::{Read, Write};
use std::os::unix::net::{UnixListener, UnixStream};
use std::path::{Path, PathBuf};
use std::process::Child;
use std::time::{Duration, Instant};

use frikan_runtime::drive::INPUT_WORDS;
use tempfile::TempDir;

use super::firmware::Firmware;
use super::protocol::{Clock, failure};
use super::{elf, qemu};
use crate::error::{Error, Result};

/// Longest wait for one answer; an answer takes a fraction of a millisecond.
const PATIENCE: Duration = Duration::from_secs(20);

/// Command of a frame: one sample.
const SAMPLE: u32 = 1;
/// Command of a frame: the image at a place of the flash is a new one.
const NEW_IMAGE: u32 = 2;
/// Command of a frame: words for a place of the flash.
const WRITE: u32 = 3;
/// Words that a frame writes, beside their place.
const WRITTEN_WORDS: usize = INPUT_WORDS - 1;
/// Status of settings that the firmware refuses.
const BAD_SETTINGS: u32 = u32::MAX;

/// A running program and the socket to its UART. The emulator ends with it.
#[derive(Debug)]
pub struct Lockstep {
    child: Child,
    stream: UnixStream,
    clock: Option<Clock>,
    /// Fewest and most instructions of a sample so far.
    instructions: Option<(u32, u32)>,
    /// Name of the target.
    target: String,
    /// Half of the flash that the target keeps for images: the image that runs stands in one, a new one is written to the other.
    half: u32,
    /// Whether the image that runs stands in the second half.
    in_second_half: bool,
    _folder: TempDir,
}

impl Lockstep {
    /// Starts the closed loop's firmware on `target` with `image` in its flash and sends it `settings`; `counts` instructions where asked.
    ///
    /// # Errors
    /// As [`super::Emulator::new`]; `FRK-I008` where the firmware refuses the image or the settings, or does not answer.
    pub fn start(target: &str, image: &[u8], settings: &[u32], counts: bool) -> Result<Self> {
        let firmware = Firmware::find()?;
        let target = firmware.target(target)?;
        let elf = firmware.build(&target, "loop")?;
        qemu::check_installed(&target)?;
        let window = elf::image_window(&elf)?;
        if image.len() as u64 > window.bytes / 2 {
            return Err(failure("the image is larger than half of the flash that the target keeps for images"));
        }
        let folder = tempfile::tempdir().map_err(|error| Error::from_io(&std::env::temp_dir(), &error))?;
        let in_folder = |name: &str| -> PathBuf { folder.path().join(name) };
        std::fs::write(in_folder(qemu::IMAGE_FILE), image)
            .map_err(|e| Error::from_io(&in_folder(qemu::IMAGE_FILE), &e))?;
        let socket = in_folder("uart");
        let listener = UnixListener::bind(&socket).map_err(|error| Error::from_io(&socket, &error))?;
        let mut command = qemu::command(&target, folder.path(), &elf, window, counts)?;
        command.args(["-chardev", "socket,id=uart,path=uart", "-serial", "chardev:uart"]);
        let mut child = command.spawn().map_err(|error| Error::from_io(Path::new(&target.emulator), &error))?;
        let stream = match accept(&listener, &socket, &mut child) {
            Ok(stream) => stream,
            Err(error) => {
                stop(&mut child);
                return Err(error);
            }
        };
        let mut running = Self {
            child,
            stream,
            clock: None,
            instructions: None,
            target: target.name,
            half: (window.bytes / 2) as u32,
            in_second_half: false,
            _folder: folder,
        };
        running.send(settings)?;
        running.send(&[image.len() as u32])?;
        let [status, empty, calibration] = running.receive()?;
        match status {
            0 => {}
            BAD_SETTINGS => return Err(failure("the firmware refuses the settings")),
            reason => return Err(failure("the firmware refuses the image").with_value(reason.to_string())),
        }
        running.clock = counts.then_some(Clock { empty, calibration });
        Ok(running)
    }

    /// Sends the words of one sample and returns those of its answer.
    ///
    /// # Errors
    /// `FRK-I008` where the firmware does not answer.
    pub fn sample<const OUT: usize>(&mut self, words: &[u32]) -> Result<[u32; OUT]> {
        self.send(&[&[SAMPLE], words].concat())?;
        let answer = self.receive::<OUT>()?;
        let [ticks] = self.receive()?;
        if let Some(clock) = self.clock {
            let count = clock.instructions(ticks)?;
            let (fewest, most) = self.instructions.unwrap_or((count, count));
            self.instructions = Some((fewest.min(count), most.max(count)));
        }
        Ok(answer)
    }

    /// Writes `image` to the half of the flash that is not in use and goes on with it, whatever it is: what is no image leaves the drive
    /// without compensation.
    ///
    /// # Errors
    /// `FRK-I008` where it is longer than half of the flash, or the firmware does not answer.
    pub fn replace_image(&mut self, image: &[u8]) -> Result<()> {
        if image.len() as u64 > u64::from(self.half) {
            return Err(failure("the image is larger than half of the flash that the target keeps for images"));
        }
        self.in_second_half = !self.in_second_half;
        let start = if self.in_second_half { self.half } else { 0 };
        for (index, bytes) in image.chunks(4 * WRITTEN_WORDS).enumerate() {
            let mut padded = [[0; 4]; WRITTEN_WORDS];
            padded.as_flattened_mut()[..bytes.len()].copy_from_slice(bytes);
            let place = start + (4 * WRITTEN_WORDS * index) as u32;
            self.command(WRITE, &[&[place], &padded.map(u32::from_le_bytes)[..]].concat())?;
        }
        let mut words = [0; INPUT_WORDS];
        [words[0], words[1]] = [start, image.len() as u32];
        self.command(NEW_IMAGE, &words)
    }

    fn command(&mut self, command: u32, words: &[u32]) -> Result<()> {
        self.send(&[&[command], words].concat())?;
        let [acknowledged] = self.receive()?;
        if acknowledged == command { Ok(()) } else { Err(failure("the firmware does not take this command")) }
    }

    /// Fewest and most instructions of a sample so far, where they are counted.
    #[must_use]
    pub fn instructions(&self) -> Option<(u32, u32)> {
        self.instructions
    }

    fn send(&mut self, words: &[u32]) -> Result<()> {
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        self.stream.write_all(&bytes).map_err(|error| self.silent(&error))
    }

    fn receive<const N: usize>(&mut self) -> Result<[u32; N]> {
        let mut bytes = [[0; 4]; N];
        self.stream.read_exact(bytes.as_flattened_mut()).map_err(|error| self.silent(&error))?;
        Ok(bytes.map(u32::from_le_bytes))
    }

    fn silent(&self, error: &std::io::Error) -> Error {
        failure(&format!("the firmware does not answer: {error}")).with_value(&self.target)
    }
}

impl Drop for Lockstep {
    fn drop(&mut self) {
        stop(&mut self.child);
    }
}

fn stop(child: &mut Child) {
    let _ = child.kill();
    let _ = child.wait();
}

/// Waits for the emulator to open its UART.
fn accept(listener: &UnixListener, socket: &Path, child: &mut Child) -> Result<UnixStream> {
    let report = |error: std::io::Error| Error::from_io(socket, &error);
    listener.set_nonblocking(true).map_err(report)?;
    let start = Instant::now();
    loop {
        match listener.accept() {
            Ok((stream, _)) => {
                stream.set_nonblocking(false).map_err(report)?;
                stream.set_read_timeout(Some(PATIENCE)).map_err(report)?;
                return Ok(stream);
            }
            Err(error) if error.kind() != std::io::ErrorKind::WouldBlock => return Err(report(error)),
            Err(_) if child.try_wait().is_ok_and(|status| status.is_some()) => {
                return Err(failure("the emulator ended before the firmware ran"));
            }
            Err(_) if start.elapsed() > PATIENCE => return Err(failure("the emulator does not open its UART")),
            Err(_) => std::thread::sleep(Duration::from_millis(2)),
        }
    }
}
