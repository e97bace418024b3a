//! What an actuator was told at even instants, and what it would have made of that with other constants.

use super::applied::{Actuator, Command, Motion};
use std::ops::Range;

/// Commands at even instants, those that act then: the delay that is known has passed.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Commanded {
    /// One a sample.
    pub commands: Vec<Command>,
    /// Samples of each recording with its actuator.
    pub actuators: Vec<(Range<usize>, Actuator)>,
    /// Torque that a weighed payload takes of the actuator's, N m, one a sample; zero where none is weighed.
    pub payload: Vec<f64>,
}

impl Commanded {
    /// The commands of one recording.
    #[must_use]
    pub fn of(commands: Vec<Command>, actuator: Actuator) -> Self {
        let actuators = vec![(0..commands.len(), actuator)];
        Self { payload: vec![0.0; commands.len()], commands, actuators }
    }

    /// The same under a payload that takes a torque, N m, one a sample.
    #[must_use]
    pub fn carrying(self, payload: Vec<f64>) -> Self {
        Self { payload, ..self }
    }

    /// What the actuator has to put out, N m a sample, so that a torque is left beside what the payload takes.
    #[must_use]
    pub fn needed(&self, torque: &[f64]) -> Vec<f64> {
        torque.iter().zip(&self.payload).map(|(torque, payload)| torque + payload).collect()
    }

    /// Puts those of a later recording behind these.
    pub fn append(&mut self, next: Self) {
        let count = self.commands.len();
        self.commands.extend(next.commands);
        self.payload.extend(next.payload);
        let later = next.actuators.into_iter();
        self.actuators.extend(later.map(|(samples, actuator)| (samples.start + count..samples.end + count, actuator)));
    }

    /// One value a sample, by its actuator and its command.
    pub fn map(&self, value: impl Fn(&Actuator, &Command, usize) -> f64) -> Vec<f64> {
        let mut values = vec![0.0; self.commands.len()];
        for (samples, actuator) in &self.actuators {
            for i in samples.clone() {
                values[i] = value(actuator, &self.commands[i], i);
            }
        }
        values
    }

    /// Torque on the joint, N m, at a motion a sample.
    pub fn torque(&self, motion: impl Fn(usize) -> Motion) -> Vec<f64> {
        self.map(|actuator, command, i| {
            let motion = motion(i);
            actuator.apply(command, motion).at(motion.velocity)
        })
    }

    /// The same commands to actuators of other constants.
    #[must_use]
    pub fn with(&self, change: impl Fn(&Actuator) -> Actuator) -> Self {
        let changed = self.actuators.iter().map(|(samples, actuator)| (samples.clone(), change(actuator)));
        Self { actuators: changed.collect(), ..self.clone() }
    }

    /// The same with a reference that moves no faster than `limit`, rad/s, over stretches of uninterrupted time of one sample every
    /// `period`, s.
    #[must_use]
    pub fn rate_limited(&self, segments: &[Range<usize>], period: f64, limit: f64) -> Self {
        let mut limited = self.clone();
        for segment in segments {
            let mut reference = RateLimited::new(limit);
            for command in &mut limited.commands[segment.clone()] {
                command.reference = reference.follow(command.reference, period);
            }
        }
        limited
    }

    /// The same with commands that act later by `samples`, negative: earlier; straight lines in between, the first and last of a stretch
    /// of uninterrupted time held beyond it.
    #[must_use]
    pub fn delayed(&self, segments: &[Range<usize>], samples: f64) -> Self {
        let mut delayed = self.clone();
        for segment in segments.iter().filter(|segment| !segment.is_empty()) {
            let (first, last) = (segment.start as f64, (segment.end - 1) as f64);
            for i in segment.clone() {
                let at = (i as f64 - samples).clamp(first, last);
                let before = at.floor() as usize;
                let after = (before + 1).min(segment.end - 1);
                delayed.commands[i] = between(&self.commands[before], &self.commands[after], at - at.floor());
            }
        }
        delayed
    }
}

/// On the way from one command to the next.
fn between(before: &Command, after: &Command, share: f64) -> Command {
    let line = |from: f64, to: f64| from + share * (to - from);
    Command {
        effort: line(before.effort, after.effort),
        reference: line(before.reference, after.reference),
        reference_velocity: line(before.reference_velocity, after.reference_velocity),
        feed_forward: line(before.feed_forward, after.feed_forward),
        ..*before
    }
}

/// A reference that moves no faster than the firmware lets it.
#[derive(Clone, Copy, Debug)]
pub struct RateLimited {
    limit: f64,
    held: Option<f64>,
}

impl RateLimited {
    /// One that moves at `limit` at most, rad/s; infinite: as it is told.
    #[must_use]
    pub fn new(limit: f64) -> Self {
        Self { limit, held: None }
    }

    /// Where the reference is, rad, `after` seconds in which it was to go to `wanted`. It begins where it is first told.
    pub fn follow(&mut self, wanted: f64, after: f64) -> f64 {
        let way = self.limit * after;
        let held = match self.held {
            Some(held) if way.is_finite() => wanted.clamp(held - way, held + way),
            _ => wanted,
        };
        self.held = Some(held);
        held
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actuator::Kind;

    fn ramp() -> Commanded {
        let command = |i: i32| Command { reference: f64::from(i), kp: Some(2.0), enabled: true, ..Command::default() };
        let mut commanded = Commanded::of((0..5).map(command).collect(), Actuator::ideal(Kind::Pd));
        commanded.append(commanded.clone());
        commanded
    }

    #[test]
    fn a_delay_stays_within_a_stretch() {
        let delayed = ramp().delayed(&[0..5, 5..10], 1.5);
        let references: Vec<f64> = delayed.commands.iter().map(|command| command.reference).collect();
        assert_eq!(references, [0.0, 0.0, 0.5, 1.5, 2.5, 0.0, 0.0, 0.5, 1.5, 2.5]);
    }

    #[test]
    fn a_reference_moves_no_faster_than_its_limit() {
        let limited = ramp().rate_limited(&[0..5, 5..10], 0.1, 5.0);
        let references: Vec<f64> = limited.commands.iter().map(|command| command.reference).collect();
        assert_eq!(references, [0.0, 0.5, 1.0, 1.5, 2.0, 0.0, 0.5, 1.0, 1.5, 2.0]);
        assert_eq!(RateLimited::new(f64::INFINITY).follow(3.0, 0.0), 3.0);
    }

    #[test]
    fn each_recording_has_its_own_actuator() {
        let mut both = ramp();
        both.actuators[1].1.limits.torque = 1.0;
        let torque = both.torque(|_| Motion::default());
        assert_eq!((torque[4], torque[9]), (8.0, 1.0));
        assert_eq!(
            both.with(|actuator| Actuator { dead_band: 1.0, ..*actuator }).torque(|_| Motion::default())[4],
            6.0
        );
    }
}
