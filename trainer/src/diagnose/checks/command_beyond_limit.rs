//! A recorded torque beyond what the drive can give is its command: what the joint felt is the limit.

use crate::diagnose::checks::note::{HealthNote, Observation};
use crate::diagnose::measurement::signals::Signals;
use crate::physics::EffectId;

/// Largest recorded torque over the drive's limit, above which the record is a command and not a torque. Chosen by
/// judgement: lower takes noise on top of a limited torque for a command, higher misses a command a little beyond the
/// limit.
const COMMAND_LIMIT_RATIO: f64 = 1.05;

/// A recorded command.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Command {
    /// What the drive gives at most, N m.
    limit: f64,
    /// Largest recorded torque, N m.
    largest: f64,
    /// Share of the samples beyond the limit.
    share: f64,
}

impl Command {
    /// The command that was recorded instead of a torque; `None` where no limit is stated or the torque stays within it.
    pub fn of(signals: &Signals) -> Option<Self> {
        let limit = signals.torque_limit?;
        let sizes = || signals.torque.iter().map(|torque| torque.abs());
        let largest = sizes().fold(0.0, f64::max);
        let beyond = sizes().filter(|size| *size > limit).count();
        let share = beyond as f64 / signals.torque.len().max(1) as f64;
        (largest > COMMAND_LIMIT_RATIO * limit).then_some(Self { limit, largest, share })
    }

    /// The signals with the torque that the drive gave.
    pub fn given(&self, signals: &Signals) -> Signals {
        let torque = signals.torque.iter().map(|torque| torque.clamp(-self.limit, self.limit)).collect();
        Signals { torque, ..signals.clone() }
    }

    /// What is wrong with the recording.
    pub(crate) fn note(&self) -> HealthNote {
        let Self { limit, largest, share } = *self;
        let observation = Observation::CommandBeyondLimit { limit, largest, share };
        HealthNote { effect: EffectId::Saturation, blocking: false, observation }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn recorded(torque: &[f64], limit: Option<f64>) -> Signals {
        Signals { torque: torque.to_vec(), torque_limit: limit, ..Signals::default() }
    }

    #[test]
    fn what_the_drive_cannot_give_is_a_command() {
        let signals = recorded(&[1.0, -8.0, 2.0, 3.0], Some(4.0));
        let command = Command::of(&signals).unwrap();
        assert_eq!((command.largest, command.share), (8.0, 0.25));
        assert_eq!(command.given(&signals).torque, [1.0, -4.0, 2.0, 3.0]);
    }

    #[test]
    fn noise_at_the_limit_is_none_and_neither_is_any_torque_of_a_drive_without_one() {
        assert_eq!(Command::of(&recorded(&[4.1, -3.0], Some(4.0))), None);
        assert_eq!(Command::of(&recorded(&[400.0], None)), None);
    }
}
