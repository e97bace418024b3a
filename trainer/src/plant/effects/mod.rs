//! Everything that can be hidden in a joint: the catalogue, structures outside it, and how each is drawn from a seed.
//!
//! An effect is drawn once, off any grid, and multiplied by an amplitude. It acts in one of five places: as a torque at
//! the joint, as inertia, as a transmission, in the actuator, or in the measurement chain.

mod dependence;
mod events;
mod measurement;
mod memory;
mod outside;
mod position;
mod rigid_body;
mod transmission;
mod velocity;

pub use outside::OUTSIDE;

use super::channels::Neighbour;
use super::friction::DryLevels;
use super::joint::Joint;
use super::random::Draws;
use super::sensors::SensorFault;
use super::transmission::Transmission;

/// One thing that can be hidden.
pub struct Entry {
    /// Name: for the catalogue that of `CONTRACT.md`.
    pub name: &'static str,
    /// The channels the torque depends on, most telling first: `velocity`, `position`, `acceleration`, `load`,
    /// `temperature`, `time`, `torque`, `other`, `distance` (since reversal), `dwell`.
    pub channels: &'static [&'static str],
    pub(crate) draw: fn(&mut Draws, &Setting) -> Mechanism,
}

/// What a draw may depend on.
pub(crate) struct Setting<'a> {
    pub(crate) joint: &'a Joint,
    pub(crate) amplitude: f64,
    /// Length of the recording, s.
    pub(crate) duration: f64,
    /// Range of the reference position, rad.
    pub(crate) range: (f64, f64),
}

/// Where an effect acts. Torques are multiplied by the amplitude later; everything else has it inside.
pub(crate) enum Mechanism {
    Torque(Box<dyn TorqueEffect>),
    Inertia(f64),
    Transmission(Transmission),
    Actuator(Box<dyn Fn(f64) -> f64>),
    Sensor(SensorFault),
}

impl Mechanism {
    pub(crate) fn torque(effect: impl TorqueEffect + 'static) -> Self {
        Self::Torque(Box::new(effect))
    }
}

/// The joint at the middle of a step.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Moment {
    pub(crate) time: f64,
    pub(crate) position: f64,
    pub(crate) velocity: f64,
    /// Low-passed over three milliseconds, so that no effect forms an algebraic loop with it.
    pub(crate) acceleration: f64,
    /// Torque the gear transmits, N m.
    pub(crate) load: f64,
    pub(crate) temperature: f64,
    /// Dissipated power, W.
    pub(crate) power: f64,
    pub(crate) other: Neighbour,
}

impl Moment {
    pub(crate) fn speed(&self) -> f64 {
        self.velocity.abs()
    }
}

/// A resisting torque: a smooth part that acts at rest too, and levels of dry friction.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Resistance {
    pub(crate) smooth: f64,
    pub(crate) dry: DryLevels,
}

impl Resistance {
    pub(crate) fn smooth(torque: f64) -> Self {
        Self { smooth: torque, dry: DryLevels::default() }
    }

    /// Dry friction of one level in both directions.
    pub(crate) fn dry(level: f64) -> Self {
        Self::sided(level, level)
    }

    pub(crate) fn sided(forward: f64, backward: f64) -> Self {
        Self { smooth: 0.0, dry: DryLevels { forward, backward } }
    }

    pub(crate) fn with_smooth(mut self, torque: f64) -> Self {
        self.smooth += torque;
        self
    }
}

/// A resisting torque with a memory of its own. Called once a step, in order.
pub(crate) trait TorqueEffect {
    fn resist(&mut self, moment: &Moment, step_s: f64) -> Resistance;
}

impl<F: FnMut(&Moment, f64) -> Resistance> TorqueEffect for F {
    fn resist(&mut self, moment: &Moment, step_s: f64) -> Resistance {
        self(moment, step_s)
    }
}

/// The catalogue of `CONTRACT.md`, and `clock_gaps`.
pub const CATALOGUE: &[Entry] = &[
    Entry { name: "stribeck", channels: &["velocity"], draw: velocity::stribeck },
    Entry { name: "viscous_nonlinearity", channels: &["velocity"], draw: velocity::viscous_nonlinearity },
    Entry { name: "direction_asymmetry", channels: &["velocity"], draw: velocity::direction_asymmetry },
    Entry { name: "temperature", channels: &["temperature", "velocity"], draw: dependence::temperature },
    Entry { name: "warm_up", channels: &["time", "velocity"], draw: dependence::warm_up },
    Entry { name: "load_friction", channels: &["load", "velocity"], draw: dependence::load_friction },
    Entry { name: "drive_backdrive", channels: &["load", "velocity"], draw: dependence::drive_backdrive },
    Entry { name: "slow_drift", channels: &["time", "velocity"], draw: dependence::slow_drift },
    Entry { name: "presliding", channels: &["distance", "velocity"], draw: memory::presliding },
    Entry { name: "frictional_lag", channels: &["velocity", "acceleration"], draw: memory::frictional_lag },
    Entry { name: "dwell_breakaway", channels: &["dwell", "distance"], draw: memory::dwell_breakaway },
    Entry { name: "position_ripple", channels: &["position"], draw: position::ripple },
    Entry { name: "kinematic_error", channels: &["position", "velocity"], draw: transmission::kinematic_error },
    Entry { name: "position_friction", channels: &["position", "velocity"], draw: position::friction },
    Entry { name: "gravity_error", channels: &["position"], draw: rigid_body::gravity_error },
    Entry { name: "inertia_error", channels: &["acceleration"], draw: rigid_body::inertia_error },
    Entry { name: "torque_scale", channels: &["torque", "load"], draw: rigid_body::torque_scale },
    Entry { name: "torque_offset", channels: &[], draw: measurement::torque_offset },
    Entry { name: "spring", channels: &["position"], draw: rigid_body::spring },
    Entry { name: "coupling", channels: &["other"], draw: rigid_body::coupling },
    Entry { name: "saturation", channels: &["torque"], draw: events::saturation },
    Entry { name: "contact", channels: &["position"], draw: events::contact },
    Entry { name: "transient_event", channels: &["time"], draw: events::transient_event },
    Entry { name: "recurrent_fault", channels: &["position"], draw: events::recurrent_fault },
    Entry { name: "backlash", channels: &["load"], draw: transmission::backlash },
    Entry { name: "elasticity", channels: &["load", "acceleration"], draw: transmission::elasticity },
    Entry { name: "windup_hysteresis", channels: &["load"], draw: transmission::windup_hysteresis },
    Entry { name: "time_misalignment", channels: &["torque"], draw: measurement::time_misalignment },
    Entry { name: "quantisation", channels: &["position"], draw: measurement::quantisation },
    Entry { name: "unit_or_sign", channels: &["torque"], draw: measurement::unit_or_sign },
    Entry { name: "clock_gaps", channels: &["time"], draw: measurement::clock_gaps },
];

/// Finds an entry of the catalogue or outside it by name.
pub fn find(name: &str) -> Option<&'static Entry> {
    CATALOGUE.iter().chain(OUTSIDE).find(|entry| entry.name == name)
}

#[cfg(test)]
mod tests;
