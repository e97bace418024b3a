//! A drive's settings, inputs and outputs as 32-bit words: what a test bench sends to a drive and gets back, over whatever carries words.
//! Numbers are the bits of `f32`.

use super::sample::{DriveInput, DriveOutput};
use crate::compensator::{Limits, Status};
use crate::controller::{Settings, Target};
use crate::supervised::adaptation::Correction;
use crate::supervised::adaptation_settings::AdaptationSettings;
use crate::supervised::{Supervised, SupervisedCompensation, Supervision, VelocitySource};

/// Words of a [`DriveInput`].
pub const INPUT_WORDS: usize = 8;
/// Words of a [`DriveOutput`].
pub const OUTPUT_WORDS: usize = 8;
/// Words of [`DriveSettings`].
pub const SETTINGS_WORDS: usize = 31;

/// All that a drive is set to, but for its model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DriveSettings {
    /// The position loop.
    pub controller: Settings,
    /// Limits of the compensation.
    pub limits: Limits,
    /// Its supervision.
    pub supervision: Supervision,
    /// Sample period, s.
    pub dt: f32,
}

impl DriveInput {
    /// Counts, target (position, velocity, acceleration; NaN for none), gravity, load, torque of the actuator (NaN for none), temperature.
    #[must_use]
    pub fn to_words(&self) -> [u32; INPUT_WORDS] {
        let none = Target { position: f32::NAN, velocity: f32::NAN, acceleration: f32::NAN };
        let Target { position, velocity, acceleration } = self.target.unwrap_or(none);
        let actuator = self.actuator.unwrap_or(f32::NAN);
        let [position, velocity, acceleration, gravity, load, actuator, temperature] =
            [position, velocity, acceleration, self.gravity, self.load, actuator, self.temperature].map(f32::to_bits);
        [self.counts.cast_unsigned(), position, velocity, acceleration, gravity, load, actuator, temperature]
    }

    /// The input of [`DriveInput::to_words`]; a target whose position is NaN is none, and so is a torque of the actuator that is NaN.
    #[must_use]
    pub fn from_words(words: &[u32; INPUT_WORDS]) -> Self {
        let [counts, numbers @ ..] = *words;
        let [position, velocity, acceleration, gravity, load, actuator, temperature] = numbers.map(f32::from_bits);
        let target = (!position.is_nan()).then_some(Target { position, velocity, acceleration });
        let actuator = (!actuator.is_nan()).then_some(actuator);
        Self { counts: counts.cast_signed(), target, gravity, load, actuator, temperature }
    }
}

impl DriveOutput {
    /// Torque, velocity, compensation, its gain share, the correction of the adaptation (level, viscous, offset), and the status: 0 active,
    /// 1 no model, 2 not finite, 3 implausible, 4 degraded.
    #[must_use]
    pub fn to_words(&self) -> [u32; OUTPUT_WORDS] {
        let status = match self.compensation.status {
            Supervised::Compensator(Status::Active) => 0,
            Supervised::Compensator(Status::NoModel(_)) => 1,
            Supervised::Compensator(Status::NotFinite) => 2,
            Supervised::Implausible => 3,
            Supervised::Degraded => 4,
        };
        let SupervisedCompensation { torque: compensation, gain_share, correction, .. } = self.compensation;
        let Correction { level, viscous, offset } = correction;
        let [torque, velocity, compensation, share, level, viscous, offset] =
            [self.torque, self.velocity, compensation, gain_share, level, viscous, offset].map(f32::to_bits);
        [torque, velocity, compensation, share, level, viscous, offset, status]
    }
}

impl DriveSettings {
    /// All settings, in the order of their fields; NaN for an adaptation that there is none of.
    #[must_use]
    pub fn to_words(&self) -> [u32; SETTINGS_WORDS] {
        let Settings { stiffness, damping, inertia, count, velocity_corner, torque_limit } = self.controller;
        let (limits, watch) = (&self.limits, &self.supervision);
        let source = match watch.source {
            VelocitySource::Measured => 0,
            VelocitySource::Reference => 1,
            VelocitySource::Blended => 2,
        };
        let adaptation = watch.adaptation.map_or([f32::NAN; 6], |adaptation| {
            let ([low, high], [viscous, offset]) = (adaptation.level(), adaptation.bounds());
            [low, high, viscous, offset, adaptation.memory(), adaptation.trusted_torque()]
        });
        let numbers = [
            stiffness,
            damping,
            inertia,
            count,
            velocity_corner,
            torque_limit,
            limits.gain(),
            limits.torque(),
            limits.slew(),
            limits.position(),
            watch.inertia,
            watch.count,
            watch.rest_velocity,
            watch.standstill,
            watch.presliding,
            watch.observer_time,
            watch.fall_time,
            watch.rise_time,
            watch.least_friction,
            watch.implausible_time,
            watch.hold_time,
            watch.turn,
            self.dt,
        ];
        let mut words = [0; SETTINGS_WORDS];
        words.iter_mut().zip(numbers.into_iter().chain(adaptation)).for_each(|(word, number)| *word = number.to_bits());
        [words[SETTINGS_WORDS - 2], words[SETTINGS_WORDS - 1]] = [source, u32::from(watch.monitored)];
        words
    }

    /// The settings of [`DriveSettings::to_words`]; `None` where the limits or the adaptation cannot be kept or the source of the velocity is
    /// unknown.
    #[must_use]
    pub fn from_words(words: &[u32; SETTINGS_WORDS]) -> Option<Self> {
        let [numbers @ .., source, monitored] = *words;
        let [
            stiffness,
            damping,
            inertia,
            count,
            velocity_corner,
            torque_limit,
            gain,
            torque,
            slew,
            position,
            watched_inertia,
            watched_count,
            rest_velocity,
            standstill,
            presliding,
            observer_time,
            fall_time,
            rise_time,
            least_friction,
            implausible_time,
            hold_time,
            turn,
            dt,
            adaptation @ ..,
        ] = numbers.map(f32::from_bits);
        let adaptation = match adaptation {
            [low, ..] if low.is_nan() => None,
            [low, high, viscous, offset, memory, trusted_torque] => {
                Some(AdaptationSettings::new([low, high], [viscous, offset], memory, trusted_torque).ok()?)
            }
        };
        let source = match source {
            0 => VelocitySource::Measured,
            1 => VelocitySource::Reference,
            2 => VelocitySource::Blended,
            _ => return None,
        };
        let supervision = Supervision {
            inertia: watched_inertia,
            count: watched_count,
            source,
            monitored: monitored != 0,
            rest_velocity,
            standstill,
            presliding,
            observer_time,
            fall_time,
            rise_time,
            least_friction,
            implausible_time,
            hold_time,
            turn,
            adaptation,
        };
        let controller = Settings { stiffness, damping, inertia, count, velocity_corner, torque_limit };
        let limits = Limits::new(gain, torque, slew).and_then(|limits| limits.with_position(position)).ok()?;
        supervision.validate().is_ok().then_some(Self { controller, limits, supervision, dt })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_bring_back_what_was_sent() {
        let controller = Settings {
            stiffness: 1.0,
            damping: 2.0,
            inertia: 3.0,
            count: 4.0,
            velocity_corner: 5.0,
            torque_limit: 6.0,
        };
        let limits = Limits::new(0.7, 8.0, 9.0).unwrap().with_position(0.1).unwrap();
        for source in [VelocitySource::Measured, VelocitySource::Reference, VelocitySource::Blended] {
            for adaptation in [None, AdaptationSettings::new([0.5, 1.5], [0.1, 0.2], 3.0, 0.05).ok()] {
                let supervision = Supervision { source, adaptation, ..Supervision::new(0.5, 2.0, 1.0e-5) };
                let settings = DriveSettings { controller, limits, supervision, dt: 1e-3 };
                assert_eq!(DriveSettings::from_words(&settings.to_words()), Some(settings));
            }
        }
        let target = Some(Target { position: 1.0, velocity: -2.0, acceleration: 3.0 });
        for (target, actuator) in [(target, None), (None, Some(0.5))] {
            let input = DriveInput { counts: -7, target, gravity: 2.0, load: 3.0, actuator, temperature: 25.0 };
            assert_eq!(DriveInput::from_words(&input.to_words()), input);
        }
    }
}
