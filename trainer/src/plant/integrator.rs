//! Integrates the closed loop of drive and joint over a campaign, sample by sample and step by step.

use super::concealed::Concealed;
use super::effects::mechanism::Moment;
use super::error::PlantError;
use super::joint::Joint;
use crate::plant::measurement::sensors::{History, encoder_step};
use crate::plant::mechanics::channels::{Housing, Neighbour, NeighbourMotion};
use crate::plant::mechanics::control::{Controller, Target, round_to};
use crate::plant::mechanics::friction::{DryLevels, Motion1D};
use crate::plant::mechanics::transmission::{Load, Push};
use crate::plant::trajectory::reference::Reference;

/// State of the moving joint.
struct Integrator<'a> {
    joint: &'a Joint,
    motor: Motion1D,
    acceleration: f64,
    power: f64,
    housing: Housing,
    /// The neighbour at the start of the sample.
    other: Neighbour,
}

/// Time over which effects see the acceleration averaged, s.
const ACCELERATION_MEMORY_S: f64 = 0.003;
/// Step in which an unrecorded rest is passed, s.
const REST_STEP_S: f64 = 0.05;
/// Beyond this speed the motion is taken to be unstable, rad/s.
const RUNAWAY_RAD_S: f64 = 1e3;

/// Integrates the whole campaign.
///
/// # Errors
/// [`PlantError::Unstable`] where the motion leaves all bounds.
pub(crate) fn integrate(
    joint: &Joint,
    references: &[(Reference, f64)],
    hidden: &mut Concealed,
    seed: u64,
) -> Result<History, PlantError> {
    let sample_s = 1.0 / joint.drive.rate_hz;
    let mut integrator = Integrator {
        joint,
        motor: Motion1D::default(),
        acceleration: 0.0,
        power: 0.0,
        housing: Housing::new(&joint.thermal),
        other: Neighbour::default(),
    };
    let neighbour = NeighbourMotion::new(&joint.other_joint, seed);
    let mut controller = Controller::new(joint);
    let mut history = History::default();
    let resolution = encoder_step(joint);
    let mut paused = 0.0;
    let mut row = 0;
    for (index, ((reference, gravity_torque), trajectory)) in references.iter().zip(joint.campaign.all()).enumerate() {
        let load = Load {
            motor_inertia: joint.motor_inertia_share * joint.inertia_kgm2,
            link_inertia: (1.0 - joint.motor_inertia_share) * joint.inertia_kgm2,
            gravity_torque: *gravity_torque,
            gravity_phase: joint.gravity_phase_rad,
        };
        integrator.rest(trajectory.pause_before_s, row as f64 / joint.drive.rate_hz + paused, &load, hidden);
        paused += trajectory.pause_before_s;
        for k in 0..reference.position.len() {
            let time = row as f64 / joint.drive.rate_hz + paused;
            let reading = round_to(integrator.motor.position, resolution);
            let target = Target {
                position: reference.position[k],
                velocity: reference.velocity[k],
                acceleration: reference.acceleration[k],
                gravity_torque: *gravity_torque,
            };
            let command = controller.torque(reading, &target);
            let applied = hidden.actuators.iter().fold(command, |torque, actuator| actuator(torque));
            let other = neighbour.at(time);
            history.time.push(time);
            history.trajectory.push(index as f64);
            history.reference.push(reference.position[k]);
            history.encoder.push(reading);
            history.position.push(integrator.motor.position);
            history.velocity.push(integrator.motor.velocity);
            history.link_position.push(hidden.transmission.link_position(integrator.motor.position));
            history.torque.push(command);
            history.gravity_torque.push(*gravity_torque);
            history.temperature.push(integrator.housing.temperature);
            history.other_position.push(other.position);
            history.other_velocity.push(other.velocity);
            history.other_acceleration.push(other.acceleration);
            let before = integrator.motor.velocity;
            integrator.other = other;
            let effect = integrator.sample(applied, time, &load, hidden);
            history.effect_torque.push(effect + command - applied);
            history.acceleration.push((integrator.motor.velocity - before) / sample_s);
            if integrator.motor.velocity.is_nan() || integrator.motor.velocity.abs() > RUNAWAY_RAD_S {
                return Err(PlantError::Unstable(time));
            }
            row += 1;
        }
    }
    Ok(history)
}

impl Integrator<'_> {
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
    fn sample(&mut self, torque: f64, time: f64, load: &Load, hidden: &mut Concealed) -> f64 {
        let steps = self.joint.drive.steps_per_sample;
        let step_s = 1.0 / (self.joint.drive.rate_hz * steps as f64);
        let true_load = Load { motor_inertia: load.motor_inertia + hidden.extra_inertia, ..*load };
        let memory = (-step_s / ACCELERATION_MEMORY_S).exp();
        let friction = &self.joint.friction;
        let mut sum = 0.0;
        for step in 0..steps {
            let moment = self.moment(time, (step as f64 + 0.5) * step_s, 0.5 * step_s, load);
            let effect = hidden.resist(&moment, step_s);
            let base = friction.dry_level(moment.speed());
            let dry = DryLevels {
                forward: (base + effect.dry.forward).max(0.0),
                backward: (base + effect.dry.backward).max(0.0),
            };
            let push = Push { torque: torque - effect.smooth, dry, viscous: friction.viscous_nm_s_rad };
            let before = self.motor;
            let stepped = hidden.transmission.step(&mut self.motor, &push, &true_load, step_s);
            let acceleration = (self.motor.velocity - before.velocity) / step_s;
            self.acceleration = acceleration + memory * (self.acceleration - acceleration);
            // The dry friction is shared between base and effects in proportion to their levels.
            let level = if stepped.dry_friction >= 0.0 { dry.forward } else { dry.backward };
            let dry_effect = if level > 0.0 {
                (level - base) / level * stepped.dry_friction
            } else {
                -base * moment.velocity.signum()
            };
            sum += effect.smooth + dry_effect + stepped.excess + hidden.extra_inertia * acceleration;
            let moved = self.motor.position - before.position;
            let drag = friction.viscous_nm_s_rad * self.motor.velocity;
            self.power = ((stepped.dry_friction + drag) * moved / step_s).abs();
            self.housing.advance(self.power, step_s);
        }
        sum / steps as f64
    }

    /// Passes an unrecorded rest: nothing moves, everything cools and dwells.
    fn rest(&mut self, pause_s: f64, start: f64, load: &Load, hidden: &mut Concealed) {
        let steps = (pause_s / REST_STEP_S).ceil() as usize;
        if steps == 0 {
            return;
        }
        let step_s = pause_s / steps as f64;
        self.motor.velocity = 0.0;
        self.power = 0.0;
        for step in 0..steps {
            let moment = self.moment(start + step as f64 * step_s, 0.0, 0.0, load);
            hidden.resist(&moment, step_s);
            self.housing.advance(0.0, step_s);
        }
    }
}
