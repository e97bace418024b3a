//! The drive's position loop: proportional-derivative control with feed-forward, once a sample.

use super::servo::Servo;
use crate::actuator::{FeedForward, Motion};
use crate::plant::joint::Joint;
use std::f64::consts::TAU;

/// One reference sample with the payload the drive believes in.
pub(crate) struct Target {
    pub(crate) position: f64,
    pub(crate) velocity: f64,
    pub(crate) acceleration: f64,
    pub(crate) gravity_torque: f64,
}

/// Controller state between two samples.
pub(crate) struct Controller {
    stiffness: f64,
    damping: f64,
    smoothing: f64,
    feed_forward: f64,
    inertia: f64,
    coulomb: f64,
    viscous: f64,
    gravity_phase: f64,
    limit: f64,
    resolution: f64,
    rate: f64,
    previous: Option<f64>,
    velocity: f64,
    servo: Option<Servo>,
}

/// Speed over which the feed-forward of dry friction changes sign, rad/s.
const FEED_FORWARD_WIDTH_RAD_S: f64 = 0.02;

impl Controller {
    pub(crate) fn new(joint: &Joint) -> Self {
        let omega = TAU * joint.control.bandwidth_hz;
        Self {
            stiffness: joint.inertia_kgm2 * omega * omega,
            damping: 2.0 * joint.control.damping_ratio * omega * joint.inertia_kgm2,
            smoothing: 1.0 - (-TAU * joint.control.velocity_corner_hz / joint.drive.rate_hz).exp(),
            feed_forward: joint.control.feed_forward,
            inertia: joint.inertia_kgm2,
            coulomb: joint.friction.coulomb_torque_nm,
            viscous: joint.friction.viscous_nm_s_rad,
            gravity_phase: joint.gravity_phase_rad,
            limit: joint.drive.torque_limit_nm,
            resolution: joint.drive.torque_resolution_nm,
            rate: joint.drive.rate_hz,
            previous: None,
            velocity: 0.0,
            servo: Servo::of(joint),
        }
    }

    /// Torque for the sample that begins now, N m, from the encoder reading of a motor at a velocity, rad/s, and what the drive writes down as
    /// commanded: the torque, or what an actuator without torque sensor is told.
    pub(crate) fn command(&mut self, measured: f64, velocity: f64, target: &Target) -> (f64, f64) {
        let raw = self.previous.map_or(0.0, |previous| (measured - previous) * self.rate);
        self.previous = Some(measured);
        self.velocity += self.smoothing * (raw - self.velocity);
        let nominal = self.inertia * target.acceleration
            + target.gravity_torque * (target.position + self.gravity_phase).sin()
            + self.coulomb * (target.velocity / FEED_FORWARD_WIDTH_RAD_S).tanh()
            + self.viscous * target.velocity;
        let torque = self.stiffness * (target.position - measured)
            + self.damping * (target.velocity - self.velocity)
            + self.feed_forward * nominal;
        let limited = if self.limit > 0.0 { torque.clamp(-self.limit, self.limit) } else { torque };
        if let Some(servo) = &mut self.servo {
            let reference = Motion { position: target.position, velocity: target.velocity };
            let form = FeedForward::of(servo.actuator().kind)[0];
            let command = servo.command(reference, limited, form, self.velocity);
            let seen = Motion { position: measured, velocity: self.velocity };
            return (servo.drive(command, seen, velocity), command.effort);
        }
        let torque = round_to(limited, self.resolution);
        (torque, torque)
    }
}

/// Nearest multiple of `step`; the value itself when `step` is 0.
pub(crate) fn round_to(value: f64, step: f64) -> f64 {
    if step > 0.0 {
        // Dividing by the inverse keeps decimal steps decimal: 31.7, not 31.700000000000003.
        let inverse = 1.0 / step;
        (value * inverse).round() / inverse
    } else {
        value
    }
}
