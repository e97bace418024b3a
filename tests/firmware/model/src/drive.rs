//! The compensator as a control loop calls it: a row holds all that the firmware hands over in one sample.

use frikan_firmware_harness::{Evaluator, Row};
use frikan_runtime::compensator::{Compensation, Limits, Status};
use frikan_runtime::measurement::Measurement;

use crate::{Joint, joint, reason};

/// Words of a row: whether to reset before the step (its lowest bit), gain, torque and slew of the limits, sample period, then the
/// measurement: velocity, position, acceleration, load, temperature and four other channels.
const ROW_WORDS: usize = 14;

/// Largest position put out, rad; that of `trainer verify`.
const POSITION_LIMIT: f32 = 0.4;

/// A drive that compensates the friction of one joint.
pub struct Drive {
    compensator: Joint,
    measurement: Measurement,
    /// Sample period, s.
    dt: f32,
    answer: Compensation,
}

impl Evaluator for Drive {
    /// Torque, position, and the number of the status.
    const OUTPUTS: usize = 3;

    fn decode(image: &'static [u8]) -> Result<Self, u32> {
        let compensator = joint(image, Limits::OFF);
        match compensator.status() {
            Status::NoModel(error) => Err(reason(error)),
            status => {
                let answer = Compensation { torque: 0.0, position: 0.0, status };
                Ok(Self { compensator, measurement: Measurement::default(), dt: 0.0, answer })
            }
        }
    }

    fn inputs(&self) -> usize {
        ROW_WORDS
    }

    fn prepare(&mut self, row: &Row) {
        let [reset, gain, torque, slew, dt, velocity, position, acceleration, load, temperature, other @ ..] = *row;
        if reset.to_bits() & 1 == 1 {
            self.compensator.reset();
        }
        // Limits that are refused leave those before in force.
        if let Ok(limits) = Limits::new(gain, torque, slew).and_then(|limits| limits.with_position(POSITION_LIMIT)) {
            self.compensator.set_limits(limits);
        }
        self.measurement = Measurement { velocity, position, acceleration, load, temperature, other };
        self.dt = dt;
    }

    fn evaluate(&mut self, _: &Row) -> f32 {
        self.answer = self.compensator.step(&self.measurement, self.dt);
        self.answer.torque
    }

    fn outputs(&self, torque: f32) -> [u32; 3] {
        let status = match self.answer.status {
            Status::Active => 0,
            Status::NotFinite => 1,
            Status::NoModel(_) => 2,
        };
        [torque.to_bits(), self.answer.position.to_bits(), status]
    }
}
