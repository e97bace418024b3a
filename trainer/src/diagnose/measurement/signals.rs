//! What the diagnosis works on: one joint's signals on an even clock, before any filter.

use crate::actuator::Commanded;
use crate::diagnose::measurement::other_joints::other_positions;
use crate::error::Result;
use crate::joint::Joint;
use crate::numerics::between_samples::between_samples;
use crate::numerics::derivatives::second_derivative;
use crate::recording::{Axis, Quantity, Recording};
use crate::samples::EvenClock;
use crate::samples::spikes::{Spikes, without_spikes};
use std::ops::Range;

/// Signals of one joint on an even clock; all series of one length; SI, joint side.
#[derive(Clone, Debug, Default)]
pub struct Signals {
    /// Sample period in s.
    pub period: f64,
    /// Time in s.
    pub time: Vec<f64>,
    /// Position in rad or m.
    pub position: Vec<f64>,
    /// Velocity as it was recorded: the diagnosis differentiates the position, and only compares both.
    pub velocity: Option<Vec<f64>>,
    /// Actuator torque (N m, N or A).
    pub torque: Vec<f64>,
    /// Torque of the nominal rigid body in the unit of the actuator, where one is given.
    pub rigid_body: Option<Vec<f64>>,
    /// Whether that was worked out from the recorded position.
    pub body_follows_position: bool,
    /// Transmitted load torque in N m.
    pub load: Option<Vec<f64>>,
    /// Temperature in degrees Celsius.
    pub temperature: Option<Vec<f64>>,
    /// Link-side position in rad or m.
    pub link_position: Option<Vec<f64>>,
    /// Positions of other joints on the same clock, in rad or m.
    pub other_positions: Vec<Vec<f64>>,
    /// Stretches of uninterrupted motion (trajectories, or pieces between gaps).
    pub segments: Vec<Range<usize>>,
    /// Motor turns per joint turn, where known.
    pub gear_ratio: Option<f64>,
    /// Whether the axis turns (else it slides).
    pub rotary: bool,
    /// Smallest step of the position in its unit; 0 when unknown.
    pub position_resolution: f64,
    /// Whether samples lie between recorded rows, whose clock jitters.
    pub resampled: bool,
    /// Whether the segments are stretches of a motion that went on between them.
    pub is_excerpt: bool,
    /// What the actuator was told, where the torque is what it made of that.
    pub commanded: Option<Commanded>,
    /// Largest torque of the drive in N m, where it is stated and the torque is recorded in N m.
    pub torque_limit: Option<f64>,
    /// Glitches of the recording that were replaced.
    pub spikes: Vec<Spikes>,
}

impl Signals {
    /// Signals of a recording on its even clock. Rigid-body parameters given for the joint become its rigid-body torque
    /// where the recording carries none; friction that was separated before holds none any more.
    ///
    /// # Errors
    /// `FRK-D009` when clock, motion or actuator is missing, `FRK-D010` when its unit is not understood, `FRK-D014` for a rigid body
    /// given in N m beside a current without a torque constant.
    pub fn of(recording: &Recording, joint: &Joint) -> Result<Self> {
        Self::behind(None, recording, joint)
    }

    /// The same of a recording that is put behind an earlier one: where both clocks jitter, on the period of that.
    ///
    /// # Errors
    /// As [`Self::of`].
    pub fn behind(before: Option<&Self>, recording: &Recording, joint: &Joint) -> Result<Self> {
        let (recording, spikes) = &without_spikes(recording);
        let even = EvenClock::at(recording, before.filter(|before| before.resampled).map(|before| before.period))?;
        let owned = |quantity| even.values(quantity).map(<[f64]>::to_vec);
        let actuator = recording.actuator();
        let channel = actuator.or_else(|| recording.separated_friction());
        let torque = match channel.and_then(|channel| even.named(&channel.name)).map(<[f64]>::to_vec) {
            Some(torque) => torque,
            None => {
                recording.require(&[Quantity::Torque, Quantity::Force, Quantity::Current], "a diagnosis")?;
                Vec::new()
            }
        };
        let position = match owned(Quantity::Position) {
            Some(position) => position,
            None => {
                recording.require(&[Quantity::Position], "a diagnosis")?;
                Vec::new()
            }
        };
        let rotary = recording.axis == Axis::Rotary;
        let body = &joint.rigid_body;
        let mut signals = Self {
            period: even.period_s,
            time: even.time.clone(),
            velocity: owned(Quantity::Velocity),
            rigid_body: owned(Quantity::RigidBodyTorque).filter(|_| actuator.is_some()),
            load: owned(Quantity::LoadTorque),
            temperature: owned(Quantity::Temperature),
            link_position: owned(Quantity::LinkPosition),
            other_positions: other_positions(recording, &even),
            segments: even.segments.clone(),
            gear_ratio: joint.drive.gear_ratio,
            rotary,
            position_resolution: recording.health.position_resolution.unwrap_or(0.0),
            resampled: even.resampled,
            is_excerpt: recording.is_excerpt,
            torque_limit: joint.drive.torque_limit_nm.filter(|_| recording.values(Quantity::Torque).is_some()),
            spikes: spikes.clone(),
            torque,
            position,
            ..Self::default()
        };
        let is_given = body.inertia_kgm2.is_some() || body.gravity_torque_nm.is_some();
        if let Some(actuator) = actuator.filter(|_| is_given && signals.rigid_body.is_none()) {
            let per_torque = joint.actuator_per_torque(actuator.unit)?;
            let phase = body.gravity_phase_rad.unwrap_or(0.0);
            let recorded_load = signals.load.as_ref().filter(|_| joint.load_stands_for_gravity());
            let gravity: Option<Vec<f64>> = match (body.gravity_torque_nm, recorded_load) {
                (Some(gravity), _) => {
                    Some(signals.position.iter().map(|q| per_torque * gravity * (q + phase).sin()).collect())
                }
                (None, Some(load)) => Some(load.iter().map(|load| per_torque * load).collect()),
                (None, None) => None,
            };
            signals.give_rigid_body(per_torque * body.inertia_kgm2.unwrap_or(0.0), gravity.as_deref());
        }
        Ok(signals)
    }

    /// Signals of a rotary joint that was recorded without a gap.
    #[cfg(test)]
    pub(crate) fn without_gap(period: f64, time: Vec<f64>, position: Vec<f64>, torque: Vec<f64>) -> Self {
        let segments = std::iter::once(0..time.len()).collect();
        Self { period, segments, time, position, torque, rotary: true, ..Self::default() }
    }

    /// The same signals as an encoder with a step would have read the position, where their own is finer.
    #[must_use]
    pub fn read_in_steps(mut self, step: f64) -> Self {
        if step > self.position_resolution {
            self.position.iter_mut().for_each(|position| *position = (*position / step).round() * step);
            self.position_resolution = step;
        }
        self
    }

    /// The same signals with the torque, recorded late by `delay` (s; negative where early), put back to its time; what has no torque
    /// then is cut off the segments.
    pub fn realigned(&self, delay: f64) -> Self {
        let mut aligned = self.clone();
        let shift = delay / self.period;
        let lost = shift.abs().ceil() as usize;
        for (segment, kept) in self.segments.iter().zip(&mut aligned.segments) {
            let recorded = &self.torque[segment.clone()];
            for i in segment.clone() {
                aligned.torque[i] = between_samples(recorded, (i - segment.start) as f64 + shift);
            }
            *kept = if shift > 0.0 {
                kept.start..kept.end.saturating_sub(lost).max(kept.start)
            } else {
                (kept.start + lost).min(kept.end)..kept.end
            };
        }
        aligned.segments.retain(|segment| segment.len() > 1);
        aligned
    }

    /// Gives the nominal rigid body as an inertia and a gravity torque a sample, in the unit of the actuator (kg m2, or kg on a linear
    /// axis).
    pub fn give_rigid_body(&mut self, inertia: f64, gravity: Option<&[f64]>) {
        let acceleration = second_derivative(&self.position, &self.segments, self.period);
        self.body_follows_position = true;
        self.rigid_body =
            Some(acceleration.iter().enumerate().map(|(i, a)| inertia * a + gravity.map_or(0.0, |g| g[i])).collect());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_torque_is_put_back_without_a_loss_of_what_swings_fast() {
        let (period, delay, order) = (0.01, 0.005, 2.0 * std::f64::consts::PI * 9.0);
        let time: Vec<f64> = (0..400).map(|i| period * f64::from(i)).collect();
        let torque = time.iter().map(|time| (order * (time - delay)).sin()).collect();
        let late = Signals { period, torque, segments: vec![0..200, 200..400], time, ..Signals::default() };
        let aligned = late.realigned(delay);
        assert_eq!(aligned.segments, [0..199, 200..399]);
        let error = |i: usize| (aligned.torque[i] - (order * late.time[i]).sin()).abs();
        assert!((2..197).chain(202..397).all(|i| error(i) < 0.004));
        assert!((0..199).chain(200..399).all(|i| error(i) < 0.3), "the ends of a segment");
    }

    #[test]
    fn the_payload_of_a_commanded_joint_is_no_part_of_its_given_body() {
        let rows: String = (0..200)
            .map(|i| {
                let time = 0.01 * f64::from(i);
                format!("{time},{},1,2\n", (3.0 * time).sin())
            })
            .collect();
        let text = format!("time_s,position_rad,torque_Nm,load_torque_Nm\n{rows}");
        let body = |actuator: &str| {
            let joint = Joint::parse(&format!("{actuator}[rigid_body]\ninertia_kgm2 = 0.5\n")).unwrap();
            let recording = crate::recording::parse("a.csv", text.as_bytes(), &Joint::default()).unwrap();
            Signals::of(&recording, &joint).unwrap().rigid_body.unwrap()[100]
        };
        let commanded = body("[actuator]\nkind = \"pd\"\nkp_Nm_rad = 20\nkd_Nms_rad = 1\n");
        assert!((body("") - commanded - 2.0).abs() < 1e-12, "{} {commanded}", body(""));
    }
}
