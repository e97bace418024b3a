//! The compensator under supervision, as a control loop calls it.

use frikan_firmware_harness::{Evaluator, Row};
use frikan_runtime::compensator::{Limits, Status};
use frikan_runtime::measurement::Measurement;
use frikan_runtime::supervised::adaptation_settings::AdaptationSettings;
use frikan_runtime::supervised::{Sample, Supervision, Supervisor};

use crate::{Joint, joint, reason};

/// Words of a row: whether the joint is learnt (its lowest bit), sample period, velocity, position, velocity of the reference, torque of the loop.
const ROW_WORDS: usize = 6;

/// Limits of the drive: gain, N m, N m/s.
const LIMITS: [f32; 3] = [0.95, 60.0, 1.0e4];

/// Inertia, kg m2, friction, N m, and count of the encoder, rad, of the joint of the tests' models.
const JOINT: [f32; 3] = [0.5, 20.0, 6.0e-6];

/// A drive that compensates the friction of one joint, supervised.
pub struct WatchedDrive {
    compensator: Joint,
    supervisor: Supervisor,
    learns: bool,
    sample: Sample,
    /// Sample period, s.
    dt: f32,
}

/// A supervisor that learns the joint, or takes the model as it is.
fn supervisor(learns: bool) -> Option<Supervisor> {
    let [inertia, friction, count] = JOINT;
    let adaptation = if learns { Some(AdaptationSettings::new([0.5, 1.5], [5.0, 5.0], 10.0, 2.0).ok()?) } else { None };
    Supervisor::new(Supervision { adaptation, ..Supervision::new(inertia, friction, count) }).ok()
}

impl Evaluator for WatchedDrive {
    fn decode(image: &'static [u8]) -> Result<Self, u32> {
        let [gain, torque, slew] = LIMITS;
        let compensator = joint(image, Limits::new(gain, torque, slew).unwrap_or(Limits::OFF));
        if let Status::NoModel(error) = compensator.status() {
            return Err(reason(error));
        }
        let supervisor = supervisor(false).ok_or(0u32)?;
        let sample = Sample { measurement: Measurement::MISSING, reference_velocity: None, loop_torque: 0.0 };
        Ok(Self { compensator, supervisor, learns: false, sample, dt: 0.0 })
    }

    fn inputs(&self) -> usize {
        ROW_WORDS
    }

    fn prepare(&mut self, row: &Row) {
        let [learns, dt, velocity, position, reference, loop_torque, ..] = *row;
        let learns = learns.to_bits() & 1 == 1;
        if learns != self.learns
            && let Some(supervisor) = supervisor(learns)
        {
            self.supervisor = supervisor;
            self.learns = learns;
        }
        let measurement = Measurement { velocity, position, ..Measurement::MISSING };
        self.sample = Sample { measurement, reference_velocity: Some(reference), loop_torque };
        self.dt = dt;
    }

    fn evaluate(&mut self, _: &Row) -> f32 {
        self.supervisor.step(&mut self.compensator, &self.sample, self.dt).torque
    }
}
