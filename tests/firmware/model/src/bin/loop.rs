//! The drive of one joint in lockstep with a joint that the host moves: a frame of sensor words in, a frame of torque words out, by UART.
//!
//! The host sends [`SETTINGS_WORDS`] of settings and the length of the image in flash, and gets the status of the image and two readings
//! of the clock. Then it sends frames of a command and [`INPUT_WORDS`]: a sample, answered by the words of its output and the ticks of the step;
//! words for a place of the flash, or the place and length of a new image, both answered by the command.
#![no_std]
#![no_main]

use frikan_firmware::{CELLS, reason};
use frikan_firmware_harness::{Uart, calibration, counted, entry, flash, start_clock, write_flash};
use frikan_runtime::compensator::{Compensator, Limits, Status};
use frikan_runtime::drive::{DriveInput, DriveSettings, INPUT_WORDS, JointDrive, SETTINGS_WORDS};
use frikan_runtime::shared::image::decode;

/// Command of a frame: one sample.
const SAMPLE: u32 = 1;
/// Command of a frame: from now on the image at a place of the flash.
const NEW_IMAGE: u32 = 2;
/// Command of a frame: words for a place of the flash.
const WRITE: u32 = 3;
/// Status of settings that cannot be kept.
const BAD_SETTINGS: u32 = u32::MAX;

#[entry]
fn main() -> ! {
    start_clock();
    let mut uart = Uart::start();
    loop {
        serve(&mut uart);
    }
}

fn serve(uart: &mut Uart) {
    let mut words = [0; SETTINGS_WORDS];
    let mut length = [0];
    uart.receive(&mut words);
    uart.receive(&mut length);
    let [length] = length;
    let [empty, nops] = calibration();
    let Some(settings) = DriveSettings::from_words(&words) else { return uart.send(&[BAD_SETTINGS, empty, nops]) };
    let compensator = Compensator::<CELLS>::new(image(0, length), Limits::OFF);
    let status = status(&compensator);
    let Ok(mut drive) = JointDrive::new(&settings, compensator) else { return uart.send(&[BAD_SETTINGS, empty, nops]) };
    uart.send(&[status, empty, nops]);
    loop {
        let mut frame = [0; 1 + INPUT_WORDS];
        uart.receive(&mut frame);
        let [command, words @ ..] = frame;
        match command {
            SAMPLE => {
                let input = DriveInput::from_words(&words);
                let (output, ticks) = counted(|| drive.step(&input));
                uart.send(&output.to_words());
                uart.send(&[ticks]);
            }
            NEW_IMAGE => {
                let [start, length, ..] = words;
                let model = decode(image(start, length)).map(|image| image.model);
                drive.compensator().replace_model(model);
                uart.send(&[command]);
            }
            WRITE => {
                let [start, content @ ..] = words;
                write_flash(start, &content);
                uart.send(&[command]);
            }
            _ => return,
        }
    }
}

/// The image of so many bytes at a place of the flash; an empty one where it does not lie in the flash kept for images.
fn image(start: u32, length: u32) -> &'static [u8] {
    let (start, length) = (start as usize, length as usize);
    flash().get(start..).and_then(|from| from.get(..length)).unwrap_or_default()
}

/// 0 for a usable image, else the number of the reason why it is none.
fn status(compensator: &Compensator<CELLS>) -> u32 {
    match compensator.status() {
        Status::NoModel(error) => reason(error),
        _ => 0,
    }
}
