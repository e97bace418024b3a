//! The joint in motion: where it stands, what is hidden in it, how warm it is.

use super::concealed::Concealed;
use super::effects::mechanism::Moment;
use super::joint::Joint;
use crate::numerics::dry_friction::{DryLevels, Motion1D};
use crate::plant::measurement::sensors::encoder_step;
use crate::plant::mechanics::channels::{Housing, Neighbour, NeighbourMotion};
use crate::plant::mechanics::contact::{Contact, STEPS_PER_SECOND};
use crate::plant::mechanics::control::round_to;
use crate::plant::mechanics::transmission::{Load, Push};

/// A joint with its state.
pub(crate) struct MovingJoint<'a> {
    pub(crate) joint: &'a Joint,
    pub(crate) hidden: Concealed,
    pub(crate) motor: Motion1D,
    pub(crate) housing: Housing,
    /// The neighbour at the start of the sample.
    pub(crate) other: Neighbour,
    /// Factor on Coulomb, Stribeck and viscous friction of the joint; 1 unless set.
    pub(crate) friction_scale: f64,
    neighbour: NeighbourMotion,
    contact: Option<Contact>,
    acceleration: f64,
    power: f64,
    resolution: f64,
}

/// Time over which effects see the acceleration averaged, s.
const ACCELERATION_MEMORY_S: f64 = 0.003;
/// Step in which an unrecorded rest is passed, s.
const REST_STEP_S: f64 = 0.05;

impl<'a> MovingJoint<'a> {
    /// The joint at rest at zero, as cold as its surroundings; the motion of its neighbour is drawn from `seed`.
    pub(crate) fn new(joint: &'a Joint, hidden: Concealed, seed: u64) -> Self {
        let stiffness = joint.friction.contact_stiffness_nm_rad;
        let contact = || Contact::new(stiffness, joint.inertia_kgm2, joint.friction.stribeck_velocity_rad_s);
        Self {
            joint,
            hidden,
            motor: Motion1D::default(),
            housing: Housing::new(&joint.thermal),
            other: Neighbour::default(),
            friction_scale: 1.0,
            neighbour: NeighbourMotion::new(&joint.other_joint, seed),
            contact: (stiffness > 0.0).then(contact),
            acceleration: 0.0,
            power: 0.0,
            resolution: encoder_step(joint),
        }
    }

    /// What the encoder reads, rad.
    pub(crate) fn reading(&self) -> f64 {
        round_to(self.motor.position, self.resolution)
    }

    /// Position of the link, rad.
    pub(crate) fn link_position(&self) -> f64 {
        self.hidden.transmission.link_position(self.motor.position)
    }

    /// Torque that acts where `command`, N m, is asked for.
    pub(crate) fn actuated(&self, command: f64) -> f64 {
        self.hidden.actuators.iter().fold(command, |torque, actuator| actuator(torque))
    }

    /// Moves the neighbour to where it is at `time`, s.
    pub(crate) fn see_neighbour(&mut self, time: f64) {
        self.other = self.neighbour.at(time);
    }

    fn steps_per_sample(&self) -> usize {
        let steps = self.joint.drive.steps_per_sample;
        let stiff = self.contact.as_ref().map(|_| (STEPS_PER_SECOND / self.joint.drive.rate_hz).ceil() as usize);
        stiff.map_or(steps, |stiff| steps.max(stiff))
    }

    fn moment(&self, start: f64, since: f64, middle: f64, load: &Load) -> Moment {
        let position = self.motor.position + middle * self.motor.velocity;
        Moment {
            time: start + since,
            position,
            velocity: self.motor.velocity,
            acceleration: self.acceleration,
            load: load.gravity(position),
            temperature: self.housing.temperature,
            power: self.power,
            other: self.other.after(since),
        }
    }

    /// One sample under held torque; returns the mean torque of the hidden effects at the joint, N m.
    pub(crate) fn sample(&mut self, torque: f64, time: f64, load: &Load) -> f64 {
        let steps = self.steps_per_sample();
        let step_s = 1.0 / (self.joint.drive.rate_hz * steps as f64);
        let true_load = Load { motor_inertia: load.motor_inertia + self.hidden.extra_inertia, ..*load };
        let memory = (-step_s / ACCELERATION_MEMORY_S).exp();
        let (friction, scale) = (&self.joint.friction, self.friction_scale);
        let viscous = scale * friction.viscous_nm_s_rad;
        let mut sum = 0.0;
        for step in 0..steps {
            let moment = self.moment(time, (step as f64 + 0.5) * step_s, 0.5 * step_s, load);
            let effect = self.hidden.resist(&moment, step_s);
            let speed = moment.speed();
            let of_load = friction.load_level(speed, torque, -moment.load);
            let base = scale * (friction.dry_level(speed) + of_load);
            let dry = DryLevels {
                forward: (base + effect.dry.forward).max(0.0),
                backward: (base + effect.dry.backward).max(0.0),
            };
            // A contact that yields is a torque of its own, and nothing is left that sticks.
            let yielding = self.contact.as_mut().map(|contact| contact.torque(moment.velocity, dry, step_s));
            let sticking = if yielding.is_some() { DryLevels::default() } else { dry };
            let push = Push { torque: torque - effect.smooth - yielding.unwrap_or(0.0), dry: sticking, viscous };
            let before = self.motor;
            let stepped = self.hidden.transmission.step(&mut self.motor, &push, &true_load, step_s);
            let acceleration = (self.motor.velocity - before.velocity) / step_s;
            self.acceleration = acceleration + memory * (self.acceleration - acceleration);
            let dry_friction = yielding.unwrap_or(stepped.dry_friction);
            // The dry friction is shared between base and effects in proportion to their levels.
            let level = if dry_friction >= 0.0 { dry.forward } else { dry.backward };
            let dry_effect =
                if level > 0.0 { (level - base) / level * dry_friction } else { -base * moment.velocity.signum() };
            sum += effect.smooth + dry_effect + stepped.excess + self.hidden.extra_inertia * acceleration;
            let moved = self.motor.position - before.position;
            let drag = viscous * self.motor.velocity;
            self.power = ((dry_friction + drag) * moved / step_s).abs();
            self.housing.advance(self.power, step_s);
        }
        sum / steps as f64
    }

    /// Passes an unrecorded rest: nothing moves, everything cools and dwells.
    pub(crate) fn rest(&mut self, pause_s: f64, start: f64, load: &Load) {
        let steps = (pause_s / REST_STEP_S).ceil() as usize;
        if steps == 0 {
            return;
        }
        let step_s = pause_s / steps as f64;
        self.motor.velocity = 0.0;
        self.power = 0.0;
        for step in 0..steps {
            let moment = self.moment(start + step as f64 * step_s, 0.0, 0.0, load);
            self.hidden.resist(&moment, step_s);
            self.housing.advance(0.0, step_s);
        }
    }
}
