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
    /// Torque of gravity that the drive knows of, N m; it is added to the loop's, unless that is the actuator's.
    pub gravity: f32,
    /// Torque that the gear carries as far as the drive knows, N m: that of gravity, or of the actuator.
    pub load: f32,
    /// Torque that an actuator which follows the position by a law of its own has put out since the sample before, N m, without what the drive
    /// adds to it; none where the loop is the drive's.
    pub actuator: Option<f32>,
    /// Temperature, degC; NaN where there is no sensor.
    pub temperature: f32,
}

/// What the drive does about it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveOutput {
    /// Torque of the motor at the joint, N m, within the torque limit; what is added to an actuator's own.
    pub torque: f32,
    /// Velocity behind the encoder's filter, rad/s.
    pub velocity: f32,
    /// What of the torque compensates friction.
    pub compensation: SupervisedCompensation,
}
