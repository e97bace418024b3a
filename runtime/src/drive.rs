//! The drive of one joint: position loop and supervised compensator, once a sample. The same code runs on the host and on the
//! emulated microcontrollers.

use crate::controller::{Controller, Settings, Target};
use crate::evaluate::limited;
use crate::friction::Measurement;
use crate::supervised::{Sample, SupervisedCompensation, SupervisedCompensator};

/// What the sensors and the reference say at the start of a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DriveInput {
    /// Counts of the encoder.
    pub counts: i32,
    /// What the joint is to do; none in hand guiding.
    pub target: Option<Target>,
    /// Torque of gravity that the drive knows of, N m; it is added to the loop's.
    pub gravity: f32,
    /// Temperature, degC; NaN where there is no sensor.
    pub temperature: f32,
}

/// What the drive does about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveOutput {
    /// Torque of the motor at the joint, N m, within the torque limit.
    pub torque: f32,
    /// Velocity behind the encoder's filter, rad/s.
    pub velocity: f32,
    /// What of the torque compensates friction.
    pub compensation: SupervisedCompensation,
}

/// A drive between two samples.
#[derive(Clone, Debug)]
pub struct JointDrive<const CELLS: usize> {
    controller: Controller,
    compensator: SupervisedCompensator<CELLS>,
    /// What the loop put out in the two samples before, without compensation and gravity, N m: it acts a sample later.
    loop_torque: [f32; 2],
}

impl<const CELLS: usize> JointDrive<CELLS> {
    /// At rest.
    #[must_use]
    pub fn new(settings: Settings, compensator: SupervisedCompensator<CELLS>) -> Self {
        Self { controller: Controller::new(settings), compensator, loop_torque: [0.0; 2] }
    }

    /// The compensator.
    pub fn compensator(&mut self) -> &mut SupervisedCompensator<CELLS> {
        &mut self.compensator
    }

    /// The answer to the sample that begins `dt` seconds after the one before; it acts one sample later.
    #[must_use]
    pub fn step(&mut self, input: &DriveInput, dt: f32) -> DriveOutput {
        let sample = self.controller.step(input.counts, input.target.as_ref(), dt);
        let [before, acting] = self.loop_torque;
        let loop_torque = sample.feedback + sample.feed_forward;
        self.loop_torque = [acting, loop_torque];
        let measurement = Measurement {
            velocity: sample.velocity,
            position: sample.position,
            acceleration: input.target.map_or(0.0, |target| target.acceleration),
            load: input.gravity,
            temperature: input.temperature,
            ..Measurement::MISSING
        };
        let reference_velocity = input.target.map(|target| target.velocity);
        let compensation = self.compensator.step(&Sample { measurement, reference_velocity, loop_torque: before }, dt);
        let torque = loop_torque + input.gravity + compensation.torque;
        let torque = limited(torque, self.controller.settings().torque_limit);
        DriveOutput { torque, velocity: sample.velocity, compensation }
    }
}
