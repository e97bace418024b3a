//! One recording of commands with what is known of its joint.

use crate::actuator::{Actuator, Applied, Motion, Open, Partial};
use crate::error::{Error, Result};
use crate::joint::{Joint, Payload};
use crate::recording::{Quantity, Recording};
use crate::rollout::{Series, State, payload, recorded};

/// A recording with its actuator as far as that is known.
pub(super) struct Commanded<'a> {
    pub(super) recording: &'a Recording,
    pub(super) partial: Partial,
    pub(super) payload: Option<Payload>,
    pub(super) series: Series,
    states: Vec<State>,
}

impl<'a> Commanded<'a> {
    /// # Errors
    /// As [`Series::of`] and [`recorded`].
    pub(super) fn of(recording: &'a Recording, joint: &Joint) -> Result<Self> {
        let joint = joint.in_recording(&recording.label);
        let mut partial = Partial::of(joint.actuator.kind, &joint.actuator.constants);
        if recording.channel(Quantity::Kp).is_some() {
            partial.open.retain(|open| *open != Open::Kp);
        }
        let series =
            Series::of(recording, &partial.actuator).map_err(|error: Error| error.in_file(recording.file()))?;
        let payload = payload(recording, &joint);
        Ok(Self { recording, series, payload, states: recorded(recording)?, partial })
    }

    /// What the actuator makes of the recorded commands and motion, row by row.
    pub(super) fn applied(&self, actuator: &Actuator) -> Vec<Applied> {
        let row = |(row, state): (usize, &State)| {
            let command = self.series.at(self.series.time[row] - actuator.delay_s, row);
            actuator.apply(&command, Motion { position: state.position, velocity: state.velocity })
        };
        self.states.iter().enumerate().map(row).collect()
    }

    /// Whether a quantity is recorded.
    pub(super) fn has(&self, quantity: Quantity) -> bool {
        self.recording.channel(quantity).is_some()
    }

    /// The recorded position at every row.
    pub(super) fn positions(&self) -> impl Iterator<Item = f64> {
        self.states.iter().map(|state| state.position)
    }

    /// 1 where the actuator is on, 0 where it is off, row by row.
    pub(super) fn enabled(&self) -> impl Iterator<Item = f64> {
        self.series.commands.iter().map(|command| if command.enabled { 1.0 } else { 0.0 })
    }

    /// The recorded velocity at every row.
    pub(super) fn velocities(&self) -> impl Iterator<Item = f64> {
        self.states.iter().map(|state| state.velocity)
    }
}
