//! Several joints side by side, as the vectors of a robot controller.

use nalgebra::SVector;

use crate::compensator::{Compensator, Status};
use crate::measurement::Measurement;

/// Compensators of `JOINTS` joints.
#[derive(Clone, Debug)]
pub struct Joints<const JOINTS: usize, const CELLS: usize> {
    compensators: [Compensator<CELLS>; JOINTS],
}

/// Measurements of all joints in one sample, in SI.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct JointMeasurements<const JOINTS: usize> {
    /// Velocities, rad/s.
    pub velocity: SVector<f32, JOINTS>,
    /// Positions, rad.
    pub position: SVector<f32, JOINTS>,
    /// Accelerations, rad/s^2.
    pub acceleration: SVector<f32, JOINTS>,
    /// Torques transmitted by the gears, N m.
    pub load: SVector<f32, JOINTS>,
    /// Temperatures, degC.
    pub temperature: SVector<f32, JOINTS>,
}

impl<const JOINTS: usize> JointMeasurements<JOINTS> {
    /// Velocities alone; everything else is missing.
    #[must_use]
    pub fn of_velocity(velocity: SVector<f32, JOINTS>) -> Self {
        let missing = SVector::from([f32::NAN; JOINTS]);
        Self { velocity, position: missing, acceleration: missing, load: missing, temperature: missing }
    }
}

impl<const JOINTS: usize, const CELLS: usize> Joints<JOINTS, CELLS> {
    /// The joints in their order.
    #[must_use]
    pub fn new(compensators: [Compensator<CELLS>; JOINTS]) -> Self {
        Self { compensators }
    }

    /// The compensators in their order.
    pub fn compensators(&mut self) -> &mut [Compensator<CELLS>; JOINTS] {
        &mut self.compensators
    }

    /// Torques and statuses after a sample period of `dt` seconds. One joint's failure leaves the others as they are.
    #[must_use]
    pub fn step(
        &mut self,
        measurements: &JointMeasurements<JOINTS>,
        dt: f32,
    ) -> (SVector<f32, JOINTS>, [Status; JOINTS]) {
        let mut torques = SVector::from([0.0; JOINTS]);
        let mut statuses = [Status::NotFinite; JOINTS];
        let channels = measurements
            .velocity
            .iter()
            .zip(&measurements.position)
            .zip(&measurements.acceleration)
            .zip(&measurements.load)
            .zip(&measurements.temperature);
        let outputs = torques.iter_mut().zip(&mut statuses);
        for ((compensator, channels), (torque, status)) in self.compensators.iter_mut().zip(channels).zip(outputs) {
            let ((((velocity, position), acceleration), load), temperature) = channels;
            let measurement = Measurement {
                velocity: *velocity,
                position: *position,
                acceleration: *acceleration,
                load: *load,
                temperature: *temperature,
                ..Measurement::default()
            };
            let compensation = compensator.step(&measurement, dt);
            (*torque, *status) = (compensation.torque, compensation.status);
        }
        (torques, statuses)
    }
}
