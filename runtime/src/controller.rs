//! The position loop of a joint drive: proportional-derivative control of the encoder's position, with the inertia fed forward.
//!
//! What a firmware has around the compensator, in the same `f32` arithmetic on every target, so that a closed loop on an emulated
//! microcontroller can be compared with the host's bit by bit.

use frikan_shared::elementary::lag_share;

/// Settings of the loop, joint side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Torque for a position error, N m/rad.
    pub stiffness: f32,
    /// Torque for a velocity error, N m s/rad.
    pub damping: f32,
    /// Inertia whose torque is fed forward, kg m^2.
    pub inertia: f32,
    /// Angle of an encoder count, rad.
    pub count: f32,
    /// Corner of the low-pass behind the differentiated encoder, rad/s.
    pub velocity_corner: f32,
    /// Largest torque of the drive, compensation included, N m.
    pub torque_limit: f32,
}

/// What the joint is to do.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Target {
    /// Position, rad.
    pub position: f32,
    /// Velocity, rad/s.
    pub velocity: f32,
    /// Acceleration, rad/s^2.
    pub acceleration: f32,
}

/// One sample of the loop.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoopSample {
    /// Position of the encoder, rad.
    pub position: f32,
    /// Velocity behind the low-pass, rad/s.
    pub velocity: f32,
    /// Torque against the errors of position and velocity, N m.
    pub feedback: f32,
    /// Torque of the inertia, N m.
    pub feed_forward: f32,
}

/// The loop between two samples.
#[derive(Clone, Debug)]
pub struct Controller {
    settings: Settings,
    /// Counts of the sample before.
    before: Option<i32>,
    velocity: f32,
}

impl Controller {
    /// At rest.
    #[must_use]
    pub fn new(settings: Settings) -> Self {
        Self { settings, before: None, velocity: 0.0 }
    }

    /// The settings.
    #[must_use]
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The sample that begins with `counts` of the encoder, `dt` seconds after the one before. Without a target the joint is free: the
    /// loop measures and applies no torque.
    #[must_use]
    pub fn step(&mut self, counts: i32, target: Option<&Target>, dt: f32) -> LoopSample {
        let Settings { stiffness, damping, inertia, count, velocity_corner, .. } = self.settings;
        let change = counts.wrapping_sub(self.before.unwrap_or(counts));
        self.before = Some(counts);
        let raw = change as f32 * count / dt;
        self.velocity += lag_share(velocity_corner * dt) * (raw - self.velocity);
        let position = counts as f32 * count;
        let still = LoopSample { position, velocity: self.velocity, feedback: 0.0, feed_forward: 0.0 };
        target.map_or(still, |target| LoopSample {
            feedback: stiffness * (target.position - position) + damping * (target.velocity - self.velocity),
            feed_forward: inertia * target.acceleration,
            ..still
        })
    }
}
