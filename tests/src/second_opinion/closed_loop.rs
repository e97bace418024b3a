//! A joint that a controller moves along a reference: semi-implicit steps, Coulomb friction that cannot overshoot.

use super::joint::Joint;
use super::motion::Trajectory;

/// A controller and what stands in its way.
pub struct Loop<'a> {
    /// The joint.
    pub joint: &'a Joint,
    /// Time of a step, s.
    pub period_s: f64,
    /// Natural frequency of the position loop, rad/s.
    pub bandwidth_rad_s: f64,
    /// Greatest torque of the drive, N m or N; none where absent.
    pub limit: Option<f64>,
    /// Torque against the motion at a position, N m or N.
    pub obstacle: Option<&'a dyn Fn(f64) -> f64>,
}

/// What the joint did.
#[derive(Clone, Debug, Default)]
pub struct Driven {
    /// Its motion.
    pub path: Trajectory,
    /// What the controller asked for, N m or N.
    pub command: Vec<f64>,
}

/// Share of the reference's torque that is fed forward.
const FEED_FORWARD: f64 = 0.9;
/// Damping gain over inertia and natural frequency.
const DAMPING: f64 = 1.6;
/// Integral gain over the proportional one, 1/s.
const INTEGRAL: f64 = 3.0;
/// Bound of the integral, Coulomb frictions.
const INTEGRAL_BOUND: f64 = 3.0;

impl Loop<'_> {
    /// Follows a reference.
    #[must_use]
    pub fn follow(&self, reference: &Trajectory) -> Driven {
        let (joint, dt) = (self.joint, self.period_s);
        let stiffness = joint.inertia * self.bandwidth_rad_s.powi(2);
        let damping = DAMPING * joint.inertia * self.bandwidth_rad_s;
        let bound = INTEGRAL_BOUND * joint.coulomb;
        let (mut q, mut v, mut integral) = (reference.position[0], reference.velocity[0], 0.0f64);
        let mut driven = Driven::default();
        for i in 0..reference.len() {
            let error = reference.position[i] - q;
            integral = (integral + INTEGRAL * stiffness * error * dt).clamp(-bound, bound);
            let command =
                fed_forward(joint, reference, i) + stiffness * error + damping * (reference.velocity[i] - v) + integral;
            let felt = self.limit.map_or(command, |limit| command.clamp(-limit, limit));
            let against = self.obstacle.map_or(0.0, |obstacle| obstacle(q));
            let free = v + dt / joint.inertia * (felt - joint.weight(q) - joint.viscous * v - against);
            let next = slowed(free, dt * joint.dry(v) / joint.inertia);
            driven.path.time.push(reference.time[i]);
            driven.path.position.push(q);
            driven.path.velocity.push(v);
            driven.path.acceleration.push((next - v) / dt);
            driven.command.push(command);
            v = next;
            q += v * dt;
        }
        driven
    }
}

/// The torque that the reference would take, less what is not known of it.
pub(super) fn fed_forward(joint: &Joint, reference: &Trajectory, i: usize) -> f64 {
    let body = joint.rigid_body(reference.position[i], reference.acceleration[i]);
    FEED_FORWARD * (body + joint.friction(reference.velocity[i]))
}

/// A velocity that dry friction brings down by `by`, to rest at most.
pub(super) fn slowed(velocity: f64, by: f64) -> f64 {
    velocity.signum() * (velocity.abs() - by).max(0.0)
}
