//! What the diagnosis works on: one joint's signals on an even clock, before any filter.

use super::filter::second_derivative;
use super::other_joints::other_positions;
use super::reference::Reference;
use crate::error::Result;
use crate::joint::Joint;
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
    /// Torque of the nominal rigid body, where one is given.
    pub rigid_body: Option<Vec<f64>>,
    /// Whether that was worked out from the recorded position.
    pub body_follows_position: bool,
    /// Transmitted load torque.
    pub load: Option<Vec<f64>>,
    /// Temperature in degrees Celsius.
    pub temperature: Option<Vec<f64>>,
    /// Link-side position.
    pub link_position: Option<Vec<f64>>,
    /// Positions of other joints on the same clock.
    pub other_positions: Vec<Vec<f64>>,
    /// The fitted model or simulation that it is compared with, at the recorded states.
    pub reference: Option<Reference>,
    /// Stretches of uninterrupted motion (trajectories, or pieces between gaps).
    pub segments: Vec<Range<usize>>,
    /// Motor turns per joint turn, where known.
    pub gear_ratio: Option<f64>,
    /// Whether the axis turns (else it slides).
    pub rotary: bool,
    /// Smallest step of the position in its unit; 0 when unknown.
    pub position_resolution: f64,
    /// Glitches of the recording that were replaced.
    pub spikes: Vec<Spikes>,
}

impl Signals {
    /// The torque that needs no identification: the reference's, or the rigid body's.
    pub(super) fn known_torque(&self) -> Option<&Vec<f64>> {
        self.reference.as_ref().map(|reference| &reference.torque).or(self.rigid_body.as_ref())
    }

    /// Signals of a recording on its even clock. Rigid-body parameters given for the joint become its rigid-body torque
    /// where the recording carries none.
    ///
    /// # Errors
    /// `FRK-D009` when clock, motion or actuator is missing.
    pub fn of(recording: &Recording, joint: &Joint) -> Result<Self> {
        let (recording, spikes) = &without_spikes(recording);
        let even = EvenClock::of(recording)?;
        let owned = |quantity| even.values(quantity).map(<[f64]>::to_vec);
        let actuator = recording
            .actuator()
            .or_else(|| recording.separated_friction())
            .and_then(|channel| even.named(&channel.name))
            .map(<[f64]>::to_vec);
        let torque = match actuator {
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
            rigid_body: owned(Quantity::RigidBodyTorque),
            load: owned(Quantity::LoadTorque),
            temperature: owned(Quantity::Temperature),
            link_position: owned(Quantity::LinkPosition),
            other_positions: other_positions(recording, &even),
            segments: even.segments.clone(),
            gear_ratio: joint.drive.gear_ratio,
            rotary,
            position_resolution: recording.health.position_resolution.unwrap_or(0.0),
            spikes: spikes.clone(),
            torque,
            position,
            ..Self::default()
        };
        if signals.rigid_body.is_none() && (body.inertia_kgm2.is_some() || body.gravity_torque_nm.is_some()) {
            let phase = body.gravity_phase_rad.unwrap_or(0.0);
            // Beside a given inertia, a recorded load torque stands for the gravity that is not given.
            let gravity = match body.gravity_torque_nm {
                Some(gravity) => Some(signals.position.iter().map(|q| gravity * (q + phase).sin()).collect()),
                None => signals.load.clone(),
            };
            signals.give_rigid_body(body.inertia_kgm2.unwrap_or(0.0), gravity.as_deref());
        }
        Ok(signals)
    }

    /// The same signals with the torque, recorded late by `delay` (s; negative where early), put back to its time by linear
    /// interpolation; what has no torque then is cut off the segments.
    pub fn realigned(&self, delay: f64) -> Self {
        let mut aligned = self.clone();
        let shift = delay / self.period;
        let lost = shift.abs().ceil() as usize;
        for (segment, kept) in self.segments.iter().zip(&mut aligned.segments) {
            for i in segment.clone() {
                let place = (i as f64 + shift).clamp(segment.start as f64, (segment.end - 1) as f64);
                let before = (place as usize).min(segment.end.saturating_sub(2).max(segment.start));
                let after = (before + 1).min(segment.end - 1);
                let share = place - before as f64;
                aligned.torque[i] = self.torque[before] + share * (self.torque[after] - self.torque[before]);
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

    /// Gives the nominal rigid body as an inertia (kg m2, or kg on a linear axis) and a gravity torque a sample.
    pub fn give_rigid_body(&mut self, inertia: f64, gravity: Option<&[f64]>) {
        let acceleration = second_derivative(&self.position, &self.segments, self.period);
        self.body_follows_position = true;
        self.rigid_body =
            Some(acceleration.iter().enumerate().map(|(i, a)| inertia * a + gravity.map_or(0.0, |g| g[i])).collect());
    }
}
