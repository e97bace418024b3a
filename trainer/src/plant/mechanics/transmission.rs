//! How the motor moves the link: rigidly, through a gear with kinematic error, or through a compliant gear.

use crate::numerics::dry_friction::{DryLevels, Motion1D, advance};
use crate::plant::joint::Joint;

/// What acts on the motor side during one step.
pub(crate) struct Push {
    /// Torque of the actuator minus every smooth resistance but gravity, N m.
    pub(crate) torque: f64,
    pub(crate) dry: DryLevels,
    pub(crate) viscous: f64,
}

/// Inertia and gravity of one payload.
#[derive(Clone, Copy)]
pub(crate) struct Load {
    pub(crate) motor_inertia: f64,
    pub(crate) link_inertia: f64,
    pub(crate) gravity_torque: f64,
    pub(crate) gravity_phase: f64,
}

impl Load {
    /// What `joint` carries under a payload of `gravity_torque` N m.
    pub(crate) fn of(joint: &Joint, gravity_torque: f64) -> Self {
        Self {
            motor_inertia: joint.motor_inertia_share * joint.inertia_kgm2,
            link_inertia: (1.0 - joint.motor_inertia_share) * joint.inertia_kgm2,
            gravity_torque,
            gravity_phase: joint.gravity_phase_rad,
        }
    }

    pub(crate) fn gravity(&self, position: f64) -> f64 {
        self.gravity_torque * (position + self.gravity_phase).sin()
    }

    pub(crate) fn inertia(&self) -> f64 {
        self.motor_inertia + self.link_inertia
    }
}

/// What a step did.
pub(crate) struct Stepped {
    /// Mean dry friction, N m.
    pub(crate) dry_friction: f64,
    /// What the transmission asks of the motor beyond the rigid law at the motor's own motion, N m: of a motor that its friction
    /// holds too, for a controller's torque does not jump where the motor stops.
    pub(crate) excess: f64,
}

/// A transmission with its state. Positions are joint angles: the motor's is divided by the gear ratio.
pub(crate) enum Transmission {
    Rigid,
    Kinematic(KinematicError),
    Compliant(Compliant),
}

/// `link = motor + sum of size * sin(order * motor + phase)` (Tuttle & Seering 1996).
pub(crate) struct KinematicError {
    /// Size in rad, order a joint turn, phase in rad.
    pub(crate) waves: Vec<(f64, f64, f64)>,
}

/// A gear that yields: elasticity (Spong 1987), backlash (Nordin & Gutman 2002), hysteretic wind-up
/// (Taghirad & Belanger 1998).
pub(crate) struct Compliant {
    pub(crate) stiffness: f64,
    pub(crate) damping: f64,
    /// Half of the dead zone, rad.
    pub(crate) half_gap: f64,
    /// Largest hysteretic torque, N m, and the twist over which it builds up, rad.
    pub(crate) hysteresis: (f64, f64),
    pub(crate) link: Option<Motion1D>,
    pub(crate) hysteresis_state: f64,
}

impl Transmission {
    /// Position of the link when the motor stands at `motor`.
    pub(crate) fn link_position(&self, motor: f64) -> f64 {
        match self {
            Self::Rigid => motor,
            Self::Kinematic(error) => motor + error.at(motor).0,
            Self::Compliant(gear) => gear.link.map_or(motor, |link| link.position),
        }
    }

    /// Advances motor and link by one step.
    pub(crate) fn step(&mut self, motor: &mut Motion1D, push: &Push, load: &Load, step_s: f64) -> Stepped {
        let middle = motor.position + 0.5 * motor.velocity * step_s;
        match self {
            Self::Rigid => {
                let torque = push.torque - load.gravity(middle);
                let dry_friction = advance(motor, torque, push.dry, push.viscous, load.inertia(), step_s);
                Stepped { dry_friction, excess: 0.0 }
            }
            Self::Kinematic(error) => {
                // Lagrange's equation for the link angle h(motor).
                let (wave, slope, curvature) = error.at(middle);
                let slope = 1.0 + slope;
                let inertia = load.motor_inertia + load.link_inertia * slope * slope;
                let centrifugal = load.link_inertia * slope * curvature * motor.velocity * motor.velocity;
                let resisting = slope * load.gravity(middle + wave) + centrifugal;
                let before = motor.velocity;
                let dry_friction = advance(motor, push.torque - resisting, push.dry, push.viscous, inertia, step_s);
                let acceleration = (motor.velocity - before) / step_s;
                let excess = (inertia - load.inertia()) * acceleration + resisting - load.gravity(middle);
                Stepped { dry_friction, excess }
            }
            Self::Compliant(gear) => gear.step(motor, push, load, step_s),
        }
    }
}

impl KinematicError {
    /// Error, its slope and its curvature over the motor angle.
    fn at(&self, motor: f64) -> (f64, f64, f64) {
        self.waves.iter().fold((0.0, 0.0, 0.0), |(value, slope, curvature), &(size, order, phase)| {
            let (sine, cosine) = (order * motor + phase).sin_cos();
            (value + size * sine, slope + size * order * cosine, curvature - size * order * order * sine)
        })
    }
}

impl Compliant {
    fn step(&mut self, motor: &mut Motion1D, push: &Push, load: &Load, step_s: f64) -> Stepped {
        let stiffest = self.stiffness + self.hysteresis.0 / self.hysteresis.1;
        let omega = (stiffest * (1.0 / load.motor_inertia + 1.0 / load.link_inertia)).sqrt();
        let pieces = (omega * step_s / 0.25).ceil().clamp(1.0, 64.0);
        let h = step_s / pieces;
        let mut link = self.link.unwrap_or_else(|| {
            // Start in equilibrium under the payload.
            Motion1D {
                position: motor.position - load.gravity(motor.position) / self.stiffness,
                velocity: motor.velocity,
            }
        });
        let (mut dry_friction, mut excess) = (0.0, 0.0);
        for _ in 0..pieces as usize {
            // Drift half a step, kick both sides, drift the other half (leapfrog).
            let motor_middle = motor.position + 0.5 * h * motor.velocity;
            let link_middle = link.position + 0.5 * h * link.velocity;
            let transmitted = self.transmit(motor_middle - link_middle, motor.velocity - link.velocity, h);
            let before = motor.velocity;
            dry_friction += advance(motor, push.torque - transmitted, push.dry, push.viscous, load.motor_inertia, h);
            link.velocity += h * (transmitted - load.gravity(link_middle)) / load.link_inertia;
            link.position = link_middle + 0.5 * h * link.velocity;
            let acceleration = (motor.velocity - before) / h;
            excess += transmitted - load.link_inertia * acceleration - load.gravity(motor_middle);
        }
        self.link = Some(link);
        Stepped { dry_friction: dry_friction / pieces, excess: excess / pieces }
    }

    /// Torque from motor to link, N m, at a twist and its rate.
    fn transmit(&mut self, twist: f64, rate: f64, step_s: f64) -> f64 {
        let (level, length) = self.hysteresis;
        if level > 0.0 {
            // Dahl's element over the twist, by its exact solution for constant direction.
            let travel = rate * step_s;
            let settled = travel.signum();
            self.hysteresis_state = settled + (self.hysteresis_state - settled) * (-travel.abs() / length).exp();
        }
        let hysteretic = level * self.hysteresis_state;
        if twist.abs() <= self.half_gap {
            return hysteretic;
        }
        let contact = self.stiffness * (twist - self.half_gap.copysign(twist));
        let torque = contact + self.damping * rate;
        // With a gap the flanks push but never pull.
        let one_sided = if self.half_gap > 0.0 && torque * twist < 0.0 { 0.0 } else { torque };
        one_sided + hysteretic
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOAD: Load = Load { motor_inertia: 0.3, link_inertia: 0.2, gravity_torque: 0.0, gravity_phase: 0.0 };
    const FREE: Push = Push { torque: 0.0, dry: DryLevels { forward: 0.0, backward: 0.0 }, viscous: 0.0 };
    const STIFFNESS: f64 = 3000.0;

    /// An undamped spring, its link at rest at a position.
    fn spring_with_link_at(position: f64) -> Compliant {
        Compliant {
            stiffness: STIFFNESS,
            damping: 0.0,
            half_gap: 0.0,
            hysteresis: (0.0, 1.0),
            link: Some(Motion1D { position, velocity: 0.0 }),
            hysteresis_state: 0.0,
        }
    }

    #[test]
    fn two_masses_keep_their_energy_and_frequency() {
        let mut gear = spring_with_link_at(1e-3);
        let mut motor = Motion1D::default();
        let mut crossings = 0;
        let mut previous = -1e-3;
        for _ in 0..20_000 {
            gear.step(&mut motor, &FREE, &LOAD, 0.00025);
            let twist = motor.position - gear.link.unwrap().position;
            crossings += usize::from(twist * previous < 0.0);
            previous = twist;
        }
        let link = gear.link.unwrap();
        let energy = 0.5 * STIFFNESS * (motor.position - link.position).powi(2)
            + 0.5 * 0.3 * motor.velocity.powi(2)
            + 0.5 * 0.2 * link.velocity.powi(2);
        assert!((energy / (0.5 * STIFFNESS * 1e-6) - 1.0).abs() < 0.05, "{energy}");
        let expected = 5.0 * (STIFFNESS / 0.12).sqrt() / std::f64::consts::PI;
        assert!((crossings as f64 - expected).abs() < 3.0, "{crossings} against {expected}");
    }

    #[test]
    fn what_the_link_asks_does_not_break_off_where_the_motor_stops() {
        let twist = 1e-3;
        let mut gear = spring_with_link_at(-twist);
        let mut motor = Motion1D::default();
        let held = Push { torque: 0.0, dry: DryLevels { forward: 50.0, backward: 50.0 }, viscous: 0.0 };
        let stepped = gear.step(&mut motor, &held, &LOAD, 1e-5);
        assert_eq!(motor.velocity, 0.0, "its friction holds the motor");
        assert!((stepped.excess - STIFFNESS * twist).abs() < 0.01, "{}", stepped.excess);
    }

    #[test]
    fn kinematic_error_asks_for_torque_that_grows_with_speed_squared() {
        let mut gear = Transmission::Kinematic(KinematicError { waves: vec![(2e-4, 60.0, 0.0)] });
        let mut peak = |speed: f64| {
            let mut largest = 0.0_f64;
            let mut motor = Motion1D { position: 0.0, velocity: speed };
            for _ in 0..2000 {
                motor.velocity = speed;
                let stepped = gear.step(&mut motor, &FREE, &LOAD, 1e-5 / speed);
                largest = largest.max(stepped.excess.abs());
            }
            largest
        };
        let ratio = peak(2.0) / peak(1.0);
        assert!((ratio - 4.0).abs() < 0.1, "{ratio}");
    }
}
