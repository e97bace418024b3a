//! What is hidden in a joint: every effect drawn from the seed and sorted by where it acts.

use super::effects::find;
use super::effects::mechanism::{Mechanism, Moment, Resistance, Setting, TorqueEffect};
use super::error::PlantError;
use super::joint::Joint;
use super::random::{Draws, Purpose};
use crate::plant::measurement::sensors::SensorFault;
use crate::plant::mechanics::transmission::Transmission;
use crate::plant::trajectory::reference::Reference;

/// Every hidden effect, sorted by where it acts.
pub(crate) struct Concealed {
    torques: Vec<(f64, Box<dyn TorqueEffect>)>,
    pub(crate) extra_inertia: f64,
    pub(crate) transmission: Transmission,
    pub(crate) actuators: Vec<Box<dyn Fn(f64) -> f64>>,
    pub(crate) faults: Vec<SensorFault>,
    pub(crate) parameters: Vec<(String, f64)>,
}

impl Concealed {
    pub(crate) fn draw(joint: &Joint, references: &[(Reference, f64)], seed: u64) -> Result<Self, PlantError> {
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
    pub(crate) fn resist(&mut self, moment: &Moment, step_s: f64) -> Resistance {
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
