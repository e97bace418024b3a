//! The drive of one joint: position loop and supervised compensator, once a sample. The same code runs on the host and on the
//! emulated microcontrollers.

use crate::bounds::limited;
use crate::compensator::Compensator;
use crate::controller::Controller;
use crate::measurement::Measurement;
use crate::supervised::{Sample, SupervisionError, Supervisor};

mod sample;
mod words;

pub use sample::{DriveInput, DriveOutput};
pub use words::{DriveSettings, INPUT_WORDS, OUTPUT_WORDS, SETTINGS_WORDS};

/// A drive between two samples.
#[derive(Clone, Debug)]
pub struct JointDrive<const CELLS: usize> {
    controller: Controller,
    compensator: Compensator<CELLS>,
    supervisor: Supervisor,
    /// What the loop put out in the two samples before, without compensation and gravity, N m: it acts a sample later.
    loop_torque: [f32; 2],
    /// Sample period, s.
    dt: f32,
}

impl<const CELLS: usize> JointDrive<CELLS> {
    /// At rest, set to `settings`; their limits are in force for the compensator.
    ///
    /// # Errors
    /// [`SupervisionError`] where a setting of the supervision is out of range.
    pub fn new(settings: &DriveSettings, mut compensator: Compensator<CELLS>) -> Result<Self, SupervisionError> {
        compensator.set_limits(settings.limits);
        Ok(Self {
            controller: Controller::new(settings.controller),
            compensator,
            supervisor: Supervisor::new(settings.supervision)?,
            loop_torque: [0.0; 2],
            dt: settings.dt,
        })
    }

    /// The compensator, for its model, its warmth and its reset.
    pub fn compensator(&mut self) -> &mut Compensator<CELLS> {
        &mut self.compensator
    }

    /// The answer to the sample that begins a sample period after the one before; it acts one sample later.
    #[must_use]
    pub fn step(&mut self, input: &DriveInput) -> DriveOutput {
        let dt = self.dt;
        let sample = self.controller.step(input.counts, input.target.as_ref(), dt);
        let [before, acting] = self.loop_torque;
        let loop_torque = sample.feedback + sample.feed_forward;
        self.loop_torque = [acting, loop_torque];
        // What acted beside compensation and gravity, and what is put out beside compensation.
        let (acted, own) =
            input.actuator.map_or((before, loop_torque + input.gravity), |torque| (torque - input.gravity, 0.0));
        let measurement = Measurement {
            velocity: sample.velocity,
            position: sample.position,
            acceleration: input.target.map_or(0.0, |target| target.acceleration),
            load: input.load,
            temperature: input.temperature,
            ..Measurement::MISSING
        };
        let reference_velocity = input.target.map(|target| target.velocity);
        let sample_of_joint = Sample { measurement, reference_velocity, loop_torque: acted };
        let compensation = self.supervisor.step(&mut self.compensator, &sample_of_joint, dt);
        let torque = limited(own + compensation.torque, self.controller.settings().torque_limit);
        DriveOutput { torque, velocity: sample.velocity, compensation }
    }
}
