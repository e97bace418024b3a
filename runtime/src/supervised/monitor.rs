//! Whether the compensation feeds the joint: a passivity observer with a gain that it lowers (after Hannaford & Ryu 2002).
//!
//! Friction and its compensation together have to dissipate: `(loop torque) v - d/dt(J v^2 / 2) >= 0`, where the loop torque is all that
//! acts on the joint but friction, compensation and outside forces. Divided by the speed this is a torque, the net friction, which both sides
//! of the difference give through the same low-pass, so that no acceleration has to be measured.

use frikan_shared::elementary::lag_share;

use super::settings::Supervision;

/// What the monitor remembers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Monitor {
    /// Loop torque behind the low-pass, N m.
    torque: f32,
    /// Velocity behind the low-pass, rad/s.
    velocity: f32,
    /// Way since the velocity changed its sign or the joint stood still, rad.
    way: f32,
    /// Share of the firmware's gain in force, 0 to 1.
    share: f32,
}

impl Monitor {
    /// Full gain, at rest.
    #[must_use]
    pub const fn new() -> Self {
        Self { torque: 0.0, velocity: 0.0, way: 0.0, share: 1.0 }
    }

    /// Share of the gain in force, 0 to 1.
    #[must_use]
    pub fn share(&self) -> f32 {
        self.share
    }

    /// Observes a sample: the measured velocity, the loop torque that acted until now, and the friction of the model at this
    /// velocity, all finite. The share falls while the net friction is negative, by the ratio of the two in `fall_time`, and rises by the
    /// same rule in `rise_time` while it is positive; it stays as it is at rest and over the first
    /// `presliding` of a way, in which a contact gives back what it had stored.
    pub fn observe(&mut self, supervision: &Supervision, velocity: f32, loop_torque: f32, friction: f32, dt: f32) {
        let smoothing = lag_share(dt / supervision.observer_time);
        let acceleration = (velocity - self.velocity) / supervision.observer_time;
        self.velocity += smoothing * (velocity - self.velocity);
        self.torque += smoothing * (loop_torque - self.torque);
        let goes_on = velocity * self.velocity > 0.0 && self.velocity.abs() > supervision.rest_velocity;
        self.way = if goes_on { self.way + velocity.abs() * dt } else { 0.0 };
        let slides = self.way > supervision.presliding;
        let net = self.torque - supervision.inertia * acceleration;
        let net = if self.velocity < 0.0 { -net } else { net };
        let ratio = net / larger(friction.abs(), supervision.least_friction);
        let time = if ratio < 0.0 { supervision.fall_time } else { supervision.rise_time };
        let share = self.share + within_1(ratio) * (dt / time);
        let share = if share > 0.0 { share } else { 0.0 };
        let share = if share < 1.0 { share } else { 1.0 };
        self.share = if slides { share } else { self.share };
    }
}

impl Default for Monitor {
    fn default() -> Self {
        Self::new()
    }
}

fn larger(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// `x` held to -1 to 1.
fn within_1(x: f32) -> f32 {
    let below = if x > 1.0 { 1.0 } else { x };
    if below < -1.0 { -1.0 } else { below }
}
