//! What goes into a drive's sample and what comes out.

use crate::controller::Target;
use crate::supervised::SupervisedCompensation;

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
