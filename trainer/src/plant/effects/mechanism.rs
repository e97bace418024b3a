//! Where an effect acts: as a torque at the joint, as inertia, as a transmission, in the actuator, or in the measurement chain.

use crate::numerics::dry_friction::DryLevels;
use crate::plant::joint::Joint;
use crate::plant::measurement::sensors::SensorFault;
use crate::plant::mechanics::channels::Neighbour;
use crate::plant::mechanics::transmission::Transmission;
use crate::plant::random::Draws;

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
