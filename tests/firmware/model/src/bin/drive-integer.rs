//! The smallest drive without floating-point unit: starts with the integer table in flash, then compensates for ever. Its size is what one costs.
#![no_std]
#![no_main]

use core::hint::black_box;

use frikan_firmware_harness::{entry, flash};
use frikan_runtime::integer::{IntegerCompensator, IntegerLimits, IntegerTableInPlace, ONE, Units};

/// Q3.12 and per mille.
const UNITS: Units = Units { velocity: 1.0 / 4096.0, torque: 0.001 };

#[entry]
fn main() -> ! {
    // Without a valid image compensation is off.
    let limits = IntegerLimits::new(ONE, 1000, 100).unwrap_or(IntegerLimits::OFF);
    let mut joint = IntegerCompensator::new(IntegerTableInPlace::at_start(flash(), UNITS), black_box(limits));
    loop {
        black_box(joint.step(black_box(0)));
    }
}
