//! What the motion tells of friction: the net friction of a joint without its acceleration being measured.
//!
//! `loop torque - J dv/dt`, where the loop torque is all that acts on the joint but friction, compensation and outside forces, both sides
//! of the difference behind the same low-pass (Hsu, Bodson, Sastry & Paden 1987). It is friction less compensation.

use super::pace::Pace;
use super::settings::Supervision;

/// The filters of the observer.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Observer {
    /// Loop torque behind the low-pass, N m.
    torque: f32,
    /// Velocity behind the low-pass, rad/s.
    velocity: f32,
    /// Way since the velocity changed its sign or the joint stood still, rad.
    way: f32,
}

/// One sample of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observation {
    /// Friction less compensation behind the low-pass, N m.
    pub net_friction: f32,
    /// Velocity behind the low-pass, rad/s.
    pub velocity: f32,
    /// Whether the joint slides: it moves, and has left the way behind over which a contact gives back what it had stored.
    pub slides: bool,
}

impl Observer {
    /// Takes the measured velocity and the loop torque that acted until now, both finite.
    pub fn observe(&mut self, supervision: &Supervision, pace: &Pace, velocity: f32, loop_torque: f32) -> Observation {
        let above = velocity - self.velocity;
        self.velocity += pace.observer * above;
        self.torque += pace.observer * (loop_torque - self.torque);
        let goes_on = velocity * self.velocity > 0.0 && self.velocity.abs() > supervision.rest_velocity;
        self.way = if goes_on { self.way + velocity.abs() * pace.dt } else { 0.0 };
        Observation {
            net_friction: self.torque - pace.inertia * above,
            velocity: self.velocity,
            slides: self.way > supervision.presliding,
        }
    }
}
