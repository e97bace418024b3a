//! The joint under test: an inertia under torque, gravity and LuGre friction, in steps far finer than the drive's samples.

use std::f64::consts::TAU;

use crate::plant::Friction;

/// Steps of integration in a second.
const STEPS_PER_SECOND: f64 = 20_000.0;

/// A joint with LuGre friction (Canudas de Wit et al. 1995), SI.
#[derive(Clone, Debug)]
pub struct LuGreJoint {
    /// Inertia, kg m^2.
    pub inertia: f64,
    /// Friction in sliding: the simulator's law.
    pub friction: Friction,
    /// Factor on all of the friction, > 0.
    pub friction_scale: f64,
    /// Stiffness of the contact in presliding, N m/rad.
    pub stiffness: f64,
    /// Amplitude, N m, and phase, rad, of the gravity torque.
    pub gravity: (f64, f64),
    /// Encoder counts a turn.
    pub counts_per_turn: f64,
}

/// Where a joint is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct JointState {
    /// Position, rad.
    pub position: f64,
    /// Velocity, rad/s.
    pub velocity: f64,
    /// Deflection of the contact, rad.
    bristle: f64,
}

impl LuGreJoint {
    /// Gravity torque at a position, N m: what the motor needs against it.
    #[must_use]
    pub fn gravity_torque(&self, position: f64) -> f64 {
        let (amplitude, phase) = self.gravity;
        amplitude * (position + phase).sin()
    }

    /// What the encoder counts, from zero at zero.
    #[must_use]
    pub fn counts(&self, position: f64) -> i32 {
        (position * self.counts_per_turn / TAU).floor() as i32
    }

    /// The position that `counts` stand for, rad.
    #[must_use]
    pub fn angle(&self, counts: i32) -> f64 {
        f64::from(counts) * TAU / self.counts_per_turn
    }

    /// Moves for `time` s under a held `torque`, N m, friction and gravity apart.
    pub fn advance(&self, state: &mut JointState, torque: f64, time: f64) {
        let steps = (time * STEPS_PER_SECOND).ceil().max(1.0);
        let step = time / steps;
        for _ in 0..steps as usize {
            self.step(state, torque - self.gravity_torque(state.position), step);
        }
    }

    /// One step: the deflection exactly for a held velocity, the velocity with the drag at its end.
    fn step(&self, state: &mut JointState, torque: f64, step: f64) {
        let speed = state.velocity.abs();
        let level = self.friction_scale * self.friction.dry_level(speed);
        // dz/dt = v - |v| z / z_slip, z_slip = level / stiffness.
        let before = state.bristle;
        if speed > 0.0 {
            let slip = (level / self.stiffness).copysign(state.velocity);
            state.bristle = slip + (before - slip) * (-speed * step / slip.abs()).exp();
        }
        // Damping of the presliding that fades in sliding keeps the friction passive (Olsson 1996); half of critical at rest.
        let fading = (-(speed / self.friction.stribeck_velocity_rad_s).powi(2)).exp();
        let damping = (self.stiffness * self.inertia).sqrt() * fading;
        let drag = self.stiffness * state.bristle + damping * (state.bristle - before) / step;
        let viscous = self.friction_scale * self.friction.viscous_nm_s_rad;
        let momentum = self.inertia * state.velocity + step * (torque - drag);
        state.velocity = momentum / (self.inertia + step * viscous);
        state.position += step * state.velocity;
    }
}
