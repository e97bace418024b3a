//! The closed loop: reference, drive, joint, history.

use super::channels::{Housing, Neighbour, NeighbourMotion};
use super::control::{Controller, Target, round_to};
use super::effects::{Mechanism, Moment, Resistance, Setting, TorqueEffect, find};
use super::friction::{DryLevels, Motion1D};
use super::joint::{Hidden, Joint};
use super::motion::Reference;
use super::random::{Draws, Purpose};
use super::recording::SimulatedRecording;
use super::sensors::{History, SensorFault, encoder_step, record};
use super::transmission::{Load, Push, Transmission};

/// What keeps a joint from being simulated.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlantError {
    /// No effect has this name.
    #[error("no effect is called `{0}`; see docs/simulate.md for the names")]
    UnknownEffect(String),
    /// A value is outside its range.
    #[error("`{key}` must be {range}, not {value}")]
    OutOfRange {
        /// Key in the `[plant]` section.
        key: &'static str,
        /// Its range in words.
        range: &'static str,
        /// The value found.
        value: f64,
    },
    /// Two hidden effects each need a transmission of their own.
    #[error("`{0}` cannot be combined with another compliant or inexact transmission")]
    TwoTransmissions(String),
    /// The motion left all bounds: the effects are too strong for the controller.
    #[error("the joint became unstable {0} s into the recording; lower the amplitudes")]
    Unstable(f64),
}

/// Simulates a recording of `joint` with its own hidden effects.
///
/// # Errors
/// [`PlantError`] for a value out of range, an unknown effect, or an unstable motion.
pub fn simulate(joint: &Joint, seed: u64) -> Result<SimulatedRecording, PlantError> {
    validate(joint)?;
    let references = references(joint, seed);
    let mut hidden = Concealed::draw(joint, &references, seed)?;
    let history = run(joint, &references, &mut hidden, seed)?;
    Ok(record(joint, history, &hidden.faults, hidden.parameters, seed))
}

/// Simulates with one more effect hidden at `amplitude`; motions, noise and the shape of the effect depend on the seed
/// alone, so that the amplitude can be scaled in a second pass.
///
/// # Errors
/// As [`simulate`].
pub fn conceal(joint: &Joint, name: &str, amplitude: f64, seed: u64) -> Result<SimulatedRecording, PlantError> {
    let mut joint = joint.clone();
    joint.effects.push(Hidden { name: name.to_owned(), amplitude });
    simulate(&joint, seed)
}

fn validate(joint: &Joint) -> Result<(), PlantError> {
    let positive = [
        ("inertia_kgm2", joint.inertia_kgm2),
        ("friction.stribeck_velocity_rad_s", joint.friction.stribeck_velocity_rad_s),
        ("control.bandwidth_Hz", joint.control.bandwidth_Hz),
        ("control.damping_ratio", joint.control.damping_ratio),
        ("control.velocity_corner_Hz", joint.control.velocity_corner_Hz),
        ("drive.rate_Hz", joint.drive.rate_Hz),
        ("drive.steps_per_sample", joint.drive.steps_per_sample as f64),
        ("drive.counts_per_turn", joint.drive.counts_per_turn),
        ("drive.gear_ratio", joint.drive.gear_ratio),
        ("noise.correlation_time_s", joint.noise.correlation_time_s),
        ("thermal.time_constant_s", joint.thermal.time_constant_s),
        ("campaign.trajectory_s", joint.campaign.trajectory_s),
    ];
    for (key, value) in positive {
        if !(value.is_finite() && value > 0.0) {
            return Err(PlantError::OutOfRange { key, range: "positive and finite", value });
        }
    }
    let not_negative = [
        ("friction.coulomb_torque_Nm", joint.friction.coulomb_torque_Nm),
        ("friction.viscous_Nm_s_rad", joint.friction.viscous_Nm_s_rad),
        ("drive.torque_resolution_Nm", joint.drive.torque_resolution_Nm),
        ("drive.torque_limit_Nm", joint.drive.torque_limit_Nm),
        ("noise.white_torque_Nm", joint.noise.white_torque_Nm),
        ("noise.coloured_torque_Nm", joint.noise.coloured_torque_Nm),
    ];
    for (key, value) in not_negative {
        if !(value.is_finite() && value >= 0.0) {
            return Err(PlantError::OutOfRange { key, range: "zero or positive, and finite", value });
        }
    }
    let share = joint.motor_inertia_share;
    if !(share > 0.0 && share < 1.0) {
        return Err(PlantError::OutOfRange { key: "motor_inertia_share", range: "between 0 and 1", value: share });
    }
    Ok(())
}

/// The reference of every trajectory, with its gravity torque.
fn references(joint: &Joint, seed: u64) -> Vec<(Reference, f64)> {
    let campaign = &joint.campaign;
    campaign
        .all()
        .enumerate()
        .map(|(index, trajectory)| {
            let mut draws = Draws::new(seed, Purpose::Motion, 1000 * (index as u64 + 1));
            let duration = trajectory.duration_s.unwrap_or(campaign.trajectory_s);
            let reference = trajectory.motion.reference(duration, joint.drive.rate_Hz, &mut draws);
            let payloads = &joint.gravity_torque_Nm;
            let in_turn = if payloads.is_empty() { 0.0 } else { payloads[index % payloads.len()] };
            (reference, trajectory.gravity_torque_Nm.unwrap_or(in_turn))
        })
        .collect()
}

/// Every hidden effect, sorted by where it acts.
struct Concealed {
    torques: Vec<(f64, Box<dyn TorqueEffect>)>,
    extra_inertia: f64,
    transmission: Transmission,
    actuators: Vec<Box<dyn Fn(f64) -> f64>>,
    faults: Vec<SensorFault>,
    parameters: Vec<(String, f64)>,
}

impl Concealed {
    fn draw(joint: &Joint, references: &[(Reference, f64)], seed: u64) -> Result<Self, PlantError> {
        let positions = references.iter().flat_map(|(reference, _)| &reference.position);
        let range = positions.fold((0.0_f64, 0.0_f64), |(low, high), &q| (low.min(q), high.max(q)));
        let mut concealed = Self {
            torques: Vec::new(),
            extra_inertia: 0.0,
            transmission: Transmission::Rigid,
            actuators: Vec::new(),
            faults: Vec::new(),
            parameters: Vec::new(),
        };
        for (index, hidden) in joint.effects.iter().enumerate() {
            let entry = find(&hidden.name).ok_or_else(|| PlantError::UnknownEffect(hidden.name.clone()))?;
            if !hidden.amplitude.is_finite() {
                let (range, value) = ("finite", hidden.amplitude);
                return Err(PlantError::OutOfRange { key: "effects.amplitude", range, value });
            }
            let setting = Setting { joint, amplitude: hidden.amplitude, duration: joint.campaign.duration_s(), range };
            let mut draws = Draws::new(seed, Purpose::Effect, index as u64);
            match (entry.draw)(&mut draws, &setting) {
                Mechanism::Torque(effect) => concealed.torques.push((hidden.amplitude, effect)),
                Mechanism::Inertia(inertia) => concealed.extra_inertia += inertia,
                Mechanism::Actuator(actuator) => concealed.actuators.push(actuator),
                Mechanism::Sensor(fault) => concealed.faults.push(fault),
                Mechanism::Transmission(_) if hidden.amplitude == 0.0 => {}
                Mechanism::Transmission(gear) => {
                    if !matches!(concealed.transmission, Transmission::Rigid) {
                        return Err(PlantError::TwoTransmissions(hidden.name.clone()));
                    }
                    concealed.transmission = gear;
                }
            }
            let named = |(name, value)| (format!("{}.{name}", hidden.name), value);
            concealed.parameters.extend(draws.into_log().into_iter().map(named));
        }
        Ok(concealed)
    }

    /// The sum of all torque effects.
    fn resist(&mut self, moment: &Moment, step_s: f64) -> Resistance {
        let mut sum = Resistance::default();
        for (amplitude, effect) in &mut self.torques {
            let part = effect.resist(moment, step_s);
            sum.smooth += *amplitude * part.smooth;
            sum.dry.forward += *amplitude * part.dry.forward;
            sum.dry.backward += *amplitude * part.dry.backward;
        }
        sum
    }
}

/// The moving joint.
struct Bench<'a> {
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

fn run(
    joint: &Joint,
    references: &[(Reference, f64)],
    hidden: &mut Concealed,
    seed: u64,
) -> Result<History, PlantError> {
    let sample_s = 1.0 / joint.drive.rate_Hz;
    let mut bench = Bench {
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
        bench.rest(trajectory.pause_before_s, row as f64 / joint.drive.rate_Hz + paused, &load, hidden);
        paused += trajectory.pause_before_s;
        for k in 0..reference.position.len() {
            let time = row as f64 / joint.drive.rate_Hz + paused;
            let reading = round_to(bench.motor.position, resolution);
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
            history.position.push(bench.motor.position);
            history.velocity.push(bench.motor.velocity);
            history.link_position.push(hidden.transmission.link_position(bench.motor.position));
            history.torque.push(command);
            history.gravity_torque.push(*gravity_torque);
            history.temperature.push(bench.housing.temperature);
            history.other_position.push(other.position);
            history.other_velocity.push(other.velocity);
            history.other_acceleration.push(other.acceleration);
            let before = bench.motor.velocity;
            bench.other = other;
            let effect = bench.sample(applied, time, &load, hidden);
            history.effect_torque.push(effect + command - applied);
            history.acceleration.push((bench.motor.velocity - before) / sample_s);
            if !(bench.motor.velocity.abs() < RUNAWAY_RAD_S) {
                return Err(PlantError::Unstable(time));
            }
            row += 1;
        }
    }
    Ok(history)
}

impl Bench<'_> {
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
        let step_s = 1.0 / (self.joint.drive.rate_Hz * steps as f64);
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
            let push = Push { torque: torque - effect.smooth, dry, viscous: friction.viscous_Nm_s_rad };
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
            let drag = friction.viscous_Nm_s_rad * self.motor.velocity;
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

#[cfg(test)]
mod tests;
