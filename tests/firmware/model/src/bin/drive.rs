//! The smallest drive of its features: starts with the image in flash, then compensates for ever. Its size is what a model costs.
#![no_std]
#![no_main]

use core::hint::black_box;

use frikan_firmware::Joint;
use frikan_firmware_harness::{entry, flash};
use frikan_runtime::compensator::Limits;
use frikan_runtime::measurement::Measurement;
#[cfg(feature = "watched")]
use frikan_runtime::supervised::{Sample, Supervision, Supervisor};
#[cfg(any(feature = "auth", feature = "slots"))]
use {
    frikan_firmware::read,
    frikan_runtime::compensator::Limited,
    frikan_shared::authentication::{KEY_BYTES, Key, Trust},
};

#[entry]
fn main() -> ! {
    // Without a valid image compensation is off.
    let mut joint = start(black_box(Limits::new(1.0, 1.0, 1.0).unwrap_or(Limits::OFF)));
    compensate(&mut joint)
}

/// With the image at the start of the flash.
#[cfg(not(any(feature = "auth", feature = "slots")))]
fn start(limits: Limits) -> Joint {
    frikan_firmware::joint(flash(), limits)
}

/// With an image that has the tag of a key.
#[cfg(all(feature = "auth", not(feature = "slots")))]
fn start(limits: Limits) -> Joint {
    let key = black_box(Key::new([0x5A; KEY_BYTES]));
    let trust = Trust::Key(&key);
    Limited::by(trust.stored(flash()).and_then(|image| read(image, trust)), limits)
}

/// With the newest usable image of two slots.
#[cfg(feature = "slots")]
fn start(limits: Limits) -> Joint {
    #[cfg(feature = "auth")]
    let key = black_box(Some(Key::new([0x5A; KEY_BYTES])));
    #[cfg(not(feature = "auth"))]
    let key: Option<Key> = None;
    let trust = key.as_ref().map_or(Trust::Anyone, Trust::Key);
    let (first, second) = flash().split_at_checked(flash().len() / 2).unwrap_or_default();
    let newest = frikan_runtime::slots::newest_usable(first, second, |image| read(image, trust));
    Limited::by(newest.map(|(_, model)| model), limits)
}

#[cfg(not(feature = "watched"))]
fn compensate(joint: &mut Joint) -> ! {
    let mut measurement = Measurement::MISSING;
    loop {
        black_box(&mut measurement);
        black_box(joint.step(&measurement, black_box(1.0e-3)));
    }
}

#[cfg(feature = "watched")]
fn compensate(joint: &mut Joint) -> ! {
    let mut supervisor = Supervisor::new(black_box(Supervision::new(1.0, 1.0)));
    let mut sample = Sample { measurement: Measurement::MISSING, reference_velocity: None, loop_torque: 0.0 };
    loop {
        black_box(&mut sample);
        black_box(supervisor.step(joint, &sample, black_box(1.0e-3)));
    }
}
