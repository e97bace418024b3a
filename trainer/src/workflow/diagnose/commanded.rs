//! Joints that report no torque: what their actuators made of the commands stands for it.

use crate::actuator::{Actuator, Commanded, Kind, Partial};
use crate::diagnose::measurement::signals::Signals;
use crate::error::Result;
use crate::joint::Joint;
use crate::recording::Recording;
use crate::rollout::Series;
use crate::servo::{Identified, Load, identify, known_torque};

/// What is known of the actuator of a joint that reports no torque: what its file gives, and of the rest what the simulation tells, whose
/// constants are those of the simulator, or else the recordings themselves. `None` of a joint that reports torque.
///
/// # Errors
/// As [`identify`].
pub(super) fn actuator(
    recordings: &[Recording],
    simulation: Option<&Recording>,
    joint: &Joint,
) -> Result<Option<Identified>> {
    match (joint.actuator.kind, simulation) {
        (Kind::Torque, _) => Ok(None),
        (_, None) => identify(recordings, joint).map(Some),
        (_, Some(simulation)) => identify(std::slice::from_ref(simulation), &joint.of_simulation()).map(Some),
    }
}

/// A recording under the torque that its actuator made, less what its payload takes; itself where it has a torque of its own.
///
/// # Errors
/// As [`known_torque`].
pub(super) fn under_torque(
    recording: Recording,
    joint: &Joint,
    actuator: Option<&Identified>,
    load: Load,
) -> Result<Recording> {
    match actuator {
        Some(identified) => known_torque(&recording, joint, identified, 0.0, load),
        None => Ok(recording),
    }
}

/// Signals of one recording as a diagnosis of it by itself weighs them: of a joint that reports no torque, under what its actuator made of
/// the commands, by constants that are given or identified in it.
///
/// # Errors
/// `FRK-D009` and `FRK-D014` for columns and constants that are missing, `FRK-N005` for a constant that the recording does not determine, and as
/// [`Signals::of`].
pub fn signals(recording: Recording, joint: &Joint) -> Result<Signals> {
    let actuator = actuator(std::slice::from_ref(&recording), None, joint)?;
    let joint = &actuator.as_ref().map_or_else(|| joint.clone(), |actuator| actuator.joint(joint));
    let told = Commands::of(&recording, joint, Load::OfPayload)?;
    let mut signals = Signals::of(&under_torque(recording, joint, actuator.as_ref(), Load::OfPayload)?, joint)?;
    signals.commanded = told.map(|told| told.at(&signals));
    Ok(signals)
}

/// What an actuator of known constants was told over a recording.
pub(super) struct Commands {
    series: Series,
    actuator: Actuator,
    load: Load,
}

impl Commands {
    /// `None` of a joint that reports torque; `load` is what its recordings have as the load of the gear.
    ///
    /// # Errors
    /// As [`Series::of`].
    pub(super) fn of(recording: &Recording, joint: &Joint, load: Load) -> Result<Option<Self>> {
        let joint = joint.in_recording(&recording.label);
        if joint.actuator.kind == Kind::Torque {
            return Ok(None);
        }
        let actuator = Partial::of(joint.actuator.kind, &joint.actuator.constants).actuator;
        Ok(Some(Self { series: Series::of(recording, &actuator)?, actuator, load }))
    }

    /// What acts at the samples of the recording under the actuator's torque.
    pub(super) fn at(&self, signals: &Signals) -> Commanded {
        let acting = |instant: &f64| {
            let time = instant - self.actuator.delay_s;
            self.series.at(time, self.series.time.partition_point(|row| *row <= time).saturating_sub(1))
        };
        let commanded = Commanded::of(signals.time.iter().map(acting).collect(), self.actuator);
        match (&signals.load, self.load) {
            (Some(payload), Load::OfPayload) => commanded.carrying(payload.clone()),
            (Some(whole), Load::OfActuator) => {
                commanded.carrying(whole.iter().zip(&signals.torque).map(|(whole, torque)| whole - torque).collect())
            }
            (None, _) | (_, Load::None) => commanded,
        }
    }
}
