//! A motor and a link with a transmission between them: play, elasticity, hysteresis.

use super::closed_loop::{fed_forward, slowed};
use super::joint::Joint;
use super::motion::Trajectory;

/// A transmission.
#[derive(Clone, Copy, Debug)]
pub struct Transmission {
    /// Stiffness, N m/rad or N/m.
    pub stiffness: f64,
    /// Half of the play, rad or m.
    pub half_play: f64,
    /// Stiffness and level of a part that slips, N m/rad and N m, or N/m and N.
    pub slipping: Option<[f64; 2]>,
    /// Natural frequency of the motor's position loop, rad/s.
    pub bandwidth_rad_s: f64,
}

/// What both masses did.
#[derive(Clone, Debug, Default)]
pub struct Driven {
    /// The motor's motion.
    pub motor: Trajectory,
    /// Position of the link, rad or m.
    pub link: Vec<f64>,
    /// What the controller asked for, N m or N.
    pub command: Vec<f64>,
}

/// Share of the inertia that turns with the motor.
pub const MOTOR_SHARE: f64 = 0.3;
/// Damping ratio of the transmission.
const DAMPING_RATIO: f64 = 0.05;
/// Damping gain of the controller over inertia and natural frequency.
const DAMPING: f64 = 1.6;
/// Integral gain over the proportional one, 1/s.
const INTEGRAL: f64 = 2.0;
/// Bound of the integral, Coulomb frictions.
const INTEGRAL_BOUND: f64 = 3.0;

impl Transmission {
    /// Moves the motor along a reference; friction acts on the motor, the weight on the link.
    #[must_use]
    pub fn follow(&self, joint: &Joint, reference: &Trajectory, period_s: f64) -> Driven {
        let dt = period_s;
        let motor = MOTOR_SHARE * joint.inertia;
        let link = joint.inertia - motor;
        let damping = 2.0 * DAMPING_RATIO * (self.stiffness * motor * link / (motor + link)).sqrt();
        // The loop sees the motor, which is the lighter part.
        let proportional = 0.5 * joint.inertia * self.bandwidth_rad_s.powi(2);
        let derivative = 0.5 * DAMPING * joint.inertia * self.bandwidth_rad_s;
        let bound = INTEGRAL_BOUND * joint.coulomb;
        let (mut q, mut v) = (reference.position[0], reference.velocity[0]);
        let (mut link_q, mut link_v) = (q, v);
        let (mut integral, mut slip) = (0.0f64, 0.0f64);
        let mut driven = Driven::default();
        for i in 0..reference.len() {
            let error = reference.position[i] - q;
            integral = (integral + INTEGRAL * proportional * error * dt).clamp(-bound, bound);
            let command = fed_forward(joint, reference, i)
                + proportional * error
                + derivative * (reference.velocity[i] - v)
                + integral;
            let twist = slowed(q - link_q, self.half_play);
            let touches = twist != 0.0 || self.half_play == 0.0;
            let mut through = self.stiffness * twist + if touches { damping * (v - link_v) } else { 0.0 };
            if let Some([stiffness, level]) = self.slipping {
                let by = (v - link_v) * dt;
                let target = level.copysign(by);
                slip = target + (slip - target) * (-by.abs() * stiffness / level).exp();
                through += slip;
            }
            let free = v + dt / motor * (command - through - joint.viscous * v);
            let next = slowed(free, dt * joint.coulomb / motor);
            driven.motor.time.push(reference.time[i]);
            driven.motor.position.push(q);
            driven.motor.velocity.push(v);
            driven.motor.acceleration.push((next - v) / dt);
            driven.link.push(link_q);
            driven.command.push(command);
            link_v += dt / link * (through - joint.weight(link_q));
            v = next;
            q += v * dt;
            link_q += link_v * dt;
        }
        driven
    }
}
