//! One joint as MuJoCo steps it: `armature`, `damping`, `frictionloss`, LuGre bristles of a `dcmotor`, and a controller.
//!
//! The equations are those of MuJoCo's documentation (chapter Computation: constraint model, numerical integration; LuGre friction in the
//! technical note of `dcmotor`), for one degree of freedom, where the constraint solver has a closed form. `tests/simulators` compares the
//! steps with those of MuJoCo.

/// How MuJoCo advances a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Integrator {
    /// Semi-implicit, the damping of joints implicit; as MuJoCo takes it where a file names none.
    Euler,
    /// `implicit` and `implicitfast`, which are the same for one joint: every force that depends on the velocity is implicit.
    Implicit,
    /// Runge-Kutta of the fourth order.
    RungeKutta,
    /// Constraints, damping and the stiffness of controllers are solved together.
    Discrete,
}

/// LuGre friction of a passive motor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bristles {
    /// N m/rad (N/m).
    pub(crate) stiffness: f64,
    /// N m s/rad (N s/m) of the bristles.
    pub(crate) damping: f64,
    /// N m (N) in motion.
    pub(crate) coulomb: f64,
    /// N m (N) at rest.
    pub(crate) at_rest: f64,
    /// rad/s (m/s), above 0.
    pub(crate) stribeck_velocity: f64,
}

impl Bristles {
    /// Rate of the deflection for each unit of it, 1/s, at most 0.
    fn decay(&self, velocity: f64) -> f64 {
        let ratio = velocity / self.stribeck_velocity.max(TINY);
        let level = self.coulomb + (self.at_rest - self.coulomb) * (-ratio * ratio).exp();
        -self.stiffness * velocity.abs() / level.max(TINY)
    }

    /// The deflection after a step at one velocity, which is exact.
    fn deflected(&self, deflection: f64, velocity: f64, step: f64) -> f64 {
        let decay = self.decay(velocity);
        let kept = (decay * step).exp();
        let integral = if decay.abs() > TINY { (kept - 1.0) / decay } else { step };
        kept * deflection + integral * velocity
    }
}

/// Below this MuJoCo takes a denominator for zero (`mjMINVAL`).
const TINY: f64 = 1e-15;

/// The softness of dry friction: `solreffriction` and `solimpfriction`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Softness {
    /// Time constant, s, and damping ratio; where the first is not above 0, minus stiffness and damping.
    pub(crate) reference: [f64; 2],
    /// Impedance at rest and in the limit, each between 0 and 1.
    pub(crate) impedance: [f64; 2],
}

impl Default for Softness {
    /// As MuJoCo has them.
    fn default() -> Self {
        Self { reference: [0.02, 1.0], impedance: [0.9, 0.95] }
    }
}

/// A joint of a simulator.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SimulatedJoint {
    /// Of bodies and armature, kg m2 (kg).
    pub(crate) inertia: f64,
    /// N m (N).
    pub(crate) friction_loss: f64,
    pub(crate) softness: Softness,
    /// Torque `a v + b v |v| + c v^3` against the motion.
    pub(crate) damping: [f64; 3],
    pub(crate) bristles: Option<Bristles>,
}

/// What moves a joint: a controller and a torque beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Drive {
    /// A torque that is held over the step: a controller outside the simulator.
    Held(f64),
    /// An actuator of the simulator: `kp (reference - q) - kv v`.
    Actuator { kp: f64, kv: f64, reference: f64 },
}

impl Drive {
    pub(crate) fn torque(self, q: f64, v: f64) -> f64 {
        match self {
            Self::Held(torque) => torque,
            Self::Actuator { kp, kv, reference } => kp * (reference - q) - kv * v,
        }
    }

    fn gains(self) -> [f64; 2] {
        match self {
            Self::Held(_) => [0.0; 2],
            Self::Actuator { kp, kv, .. } => [kp, kv],
        }
    }
}

/// Position, velocity, and deflection of the bristles.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Motion {
    pub(crate) q: f64,
    pub(crate) v: f64,
    pub(crate) z: f64,
}

/// Rates of a motion, and the force behind the acceleration.
#[derive(Clone, Copy)]
struct Rates {
    force: f64,
    acceleration: f64,
    deflection: f64,
}

impl SimulatedJoint {
    /// Advances by a step under a drive and a torque `other` that depends on the position (gravity).
    pub(crate) fn step(
        &self,
        motion: &mut Motion,
        drive: Drive,
        other: &impl Fn(f64) -> f64,
        integrator: Integrator,
        step: f64,
    ) {
        let rates = |at: &Motion| self.rates(at, drive, other, step);
        match integrator {
            Integrator::Euler => {
                let inertia = self.inertia + step * self.damping_slope(motion.v);
                let acceleration = rates(motion).force / inertia;
                self.advance(motion, acceleration, step);
            }
            Integrator::Implicit => {
                let [_, kv] = drive.gains();
                let slope = self.damping_slope(motion.v) + kv + self.bristles.map_or(0.0, |bristles| bristles.damping);
                let acceleration = rates(motion).force / (self.inertia + step * slope);
                self.advance(motion, acceleration, step);
            }
            Integrator::Discrete => {
                let acceleration = self.discrete_acceleration(motion, drive, other, step);
                self.advance(motion, acceleration, step);
            }
            Integrator::RungeKutta => self.runge_kutta(motion, rates, step),
        }
    }

    /// Force of everything but constraints, and the rate of the deflection.
    fn smooth(&self, at: &Motion, drive: Drive, other: &impl Fn(f64) -> f64) -> (f64, f64) {
        let [a, b, c] = self.damping;
        let mut force = drive.torque(at.q, at.v) + other(at.q) - (a + b * at.v.abs() + c * at.v * at.v) * at.v;
        let mut deflection = 0.0;
        if let Some(bristles) = &self.bristles {
            deflection = bristles.decay(at.v) * at.z + at.v;
            force -= bristles.stiffness * at.z + bristles.damping * deflection;
        }
        (force, deflection)
    }

    /// Slope of the damping over the velocity.
    fn damping_slope(&self, v: f64) -> f64 {
        let [a, b, c] = self.damping;
        a + 2.0 * b * v.abs() + 3.0 * c * v * v
    }

    /// Regularisation of the constraint of dry friction on an inertia, and the velocity gain of its reference acceleration, 1/s.
    fn softness_at(&self, inertia: f64, step: f64) -> (f64, f64) {
        let [at_rest, limit] = self.softness.impedance.map(|impedance| impedance.clamp(1e-4, 0.9999));
        let [time, ratio] = self.softness.reference;
        let gain = if time > 0.0 { 2.0 / (limit * time.max(2.0 * step)) } else { -ratio / limit };
        ((1.0 - at_rest) / at_rest / inertia, gain)
    }

    fn rates(&self, at: &Motion, drive: Drive, other: &impl Fn(f64) -> f64, step: f64) -> Rates {
        let (smooth, deflection) = self.smooth(at, drive, other);
        let (regularisation, gain) = self.softness_at(self.inertia, step);
        let weight = 1.0 / regularisation;
        // The acceleration that minimises Gauss' principle with the friction's Huber cost: quadratic inside the bound, which holds
        // where the force of the quadratic part stays below it.
        let inside = (smooth - weight * gain * at.v) / (self.inertia + weight);
        let friction = self.bounded(-weight * (inside + gain * at.v));
        let force = smooth + friction;
        Rates { force, acceleration: force / self.inertia, deflection }
    }

    fn bounded(&self, force: f64) -> f64 {
        if self.friction_loss > 0.0 { force.clamp(-self.friction_loss, self.friction_loss) } else { 0.0 }
    }

    /// The step map of the `discrete` integrator.
    fn discrete_acceleration(&self, at: &Motion, drive: Drive, other: &impl Fn(f64) -> f64, step: f64) -> f64 {
        let [kp, kv] = drive.gains();
        let slope = self.damping_slope(at.v).max(0.0) + kv + self.bristles.map_or(0.0, |bristles| bristles.damping);
        let inertia = self.inertia + step * slope + step * step * kp;
        let (smooth, _) = self.smooth(at, drive, other);
        let smooth = smooth - step * kp * at.v;
        let (regularisation, gain) = self.softness_at(inertia, step);
        let weight = (1.0 + gain * step) / regularisation;
        let reference = gain * at.v / (1.0 + gain * step);
        let inside = (smooth - weight * reference) / (inertia + weight);
        (smooth + self.bounded(-weight * (inside + reference))) / inertia
    }

    fn advance(&self, motion: &mut Motion, acceleration: f64, step: f64) {
        if let Some(bristles) = &self.bristles {
            motion.z = bristles.deflected(motion.z, motion.v, step);
        }
        motion.v += step * acceleration;
        motion.q += step * motion.v;
    }

    fn runge_kutta(&self, motion: &mut Motion, rates: impl Fn(&Motion) -> Rates, step: f64) {
        let start = *motion;
        let mut at = start;
        let mut first = rates(&at);
        let mut sums = [at.v, first.acceleration];
        for (share, weight) in [(0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
            let next = Motion {
                q: start.q + share * step * at.v,
                v: start.v + share * step * first.acceleration,
                z: start.z + share * step * first.deflection,
            };
            at = next;
            first = rates(&at);
            sums = [sums[0] + weight * at.v, sums[1] + weight * first.acceleration];
        }
        motion.q = start.q + step * sums[0] / 6.0;
        motion.v = start.v + step * sums[1] / 6.0;
        // The deflection takes one exact step at the velocity of the start.
        motion.z = self.bristles.map_or(0.0, |bristles| bristles.deflected(start.z, start.v, step));
    }
}
