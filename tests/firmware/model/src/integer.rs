//! The compensator of a drive without floating-point unit, as its control loop calls it: counts in, counts out.

use frikan_firmware_harness::{Evaluator, Row};
use frikan_runtime::integer::{IntegerCompensator, IntegerLimits, IntegerTableInPlace, Units};
use frikan_shared::image::IntegerTableImage;

use crate::reason;

/// Words of a row: whether to reset before the step (its lowest bit), gain, torque and slew of the limits as whole numbers, the units of velocity and
/// torque, the velocity in counts.
const ROW_WORDS: usize = 7;

/// A drive that compensates the friction of one joint.
pub struct CountingDrive {
    compensator: IntegerCompensator<'static>,
    image: &'static [u8],
    units: [u32; 2],
    velocity: i32,
}

impl CountingDrive {
    /// Counts of other units from now on, where these are others and there is a table for them.
    fn count_in(&mut self, units: [f32; 2]) {
        let bits = units.map(f32::to_bits);
        if self.units != bits {
            self.units = bits;
            let [velocity, torque] = units;
            if let Ok(table) = IntegerTableInPlace::new(self.image, Units { velocity, torque }) {
                self.compensator.replace(Ok(table));
            }
        }
    }
}

impl Evaluator for CountingDrive {
    /// With the steps of the table as counts, until a row names others.
    fn decode(image: &'static [u8]) -> Result<Self, u32> {
        let table = IntegerTableImage::read(image).and_then(|table| {
            IntegerTableInPlace::of(table, Units { velocity: table.input_step, torque: coarse(table.output_step) })
        });
        let compensator = IntegerCompensator::new(Ok(table.map_err(reason)?), IntegerLimits::OFF);
        Ok(Self { compensator, image, units: [0; 2], velocity: 0 })
    }

    fn inputs(&self) -> usize {
        ROW_WORDS
    }

    fn prepare(&mut self, row: &Row) {
        let [reset, gain, torque, slew, velocity_unit, torque_unit, velocity, ..] = *row;
        self.count_in([velocity_unit, torque_unit]);
        if reset.to_bits() & 1 == 1 {
            self.compensator.reset();
        }
        // Limits that are refused leave those before in force.
        let [gain, torque, slew] = [gain, torque, slew].map(|limit| limit.to_bits() as u16);
        if let Ok(limits) = IntegerLimits::new(gain, torque, slew) {
            self.compensator.set_limits(limits);
        }
        self.velocity = velocity.to_bits() as i32;
    }

    /// Torque in counts, in the bits of the answer.
    fn evaluate(&mut self, _: &Row) -> f32 {
        f32::from_bits(self.compensator.step(self.velocity) as u32)
    }
}

/// `2^14` times a number that is not subnormal, by its exponent.
fn coarse(step: f32) -> f32 {
    f32::from_bits(step.to_bits() + (14 << 23))
}
