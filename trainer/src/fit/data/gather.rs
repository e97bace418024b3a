//! Recordings become what is learnt from: filtered samples, the rigid body's columns, the target, blocks to hold out.

use std::ops::Range;

use super::turns::{self, Repetition};
use crate::error::{Error, Result, codes};
use crate::joint::Joint;
use crate::numerics::derivatives::first_derivative;
use crate::recording::Recording;
use crate::samples::blocks::{Split, blocks, correlation_time};
use crate::samples::delay::torque_delay;
use crate::samples::rigid_body::{Separation, TermKind, separate, separate_averaged};
use crate::samples::states::{States, states};
use crate::samples::{Preparation, Request, Samples, prepare, thinned};

/// Below this share of the top speed friction is no function of velocity.
pub(in crate::fit) const REST_SHARE: f64 = 0.001;

/// A law of a few tens of parameters learns nothing from more samples than this; only time would grow with them.
const MOST_ROWS: usize = 50_000;

/// Most samples of all recordings together, whose blocks, correlation and inputs are looked at: some 150 B each.
const MOST_SAMPLES: f64 = 500_000.0;

/// Fewest blocks: three to learn from, one to choose by, one to compare on.
const LEAST_BLOCKS: usize = 5;

/// An inertia of which noise takes more than this share is not known at all.
pub(in crate::fit) const MOST_ATTENUATION: f64 = 0.9;

/// Share of the largest step that a velocity could take from sample to sample, below which its change is the rounding of arithmetic.
const ROUNDING: f64 = 1e-9;

/// A column of the rigid body whose coefficient is identified along with friction.
#[derive(Clone, Debug)]
pub(in crate::fit) struct RigidColumn {
    pub(in crate::fit) kind: TermKind,
    pub(in crate::fit) values: Vec<f64>,
}

/// What a friction law is learnt from. All columns have one value for each row.
#[derive(Clone, Debug)]
pub(in crate::fit) struct Material {
    pub(in crate::fit) samples: Samples,
    /// Actuator less the rigid body given in `joint.toml`, or friction where it is recorded separated: averages over states.
    pub(in crate::fit) target: Vec<f64>,
    /// What friction averaged over the states of a sample is more than friction at its velocity.
    pub(in crate::fit) bend: Vec<f64>,
    /// The states that each row averages over; `None` where rows are no averages.
    pub(in crate::fit) states: Option<States>,
    /// Friction after a preliminary separation, without the bend; what inputs are judged by.
    pub(in crate::fit) friction: Vec<f64>,
    pub(in crate::fit) columns: Vec<RigidColumn>,
    /// `None` where friction is recorded separated.
    pub(in crate::fit) separation: Option<Separation>,
    /// Samples that are learnt from: those in motion, of a very long recording every `stride`-th.
    pub(in crate::fit) rows: Vec<usize>,
    pub(in crate::fit) stride: usize,
    /// Blocks of those rows by role, as positions in `rows`: once, or several times with other blocks locked.
    pub(in crate::fit) turns: Vec<Split>,
    /// Block of each row.
    pub(in crate::fit) labels: Vec<usize>,
    /// Noise of the acceleration in the samples, rad/s2 or m/s2.
    pub(in crate::fit) acceleration_noise: f64,
    /// Noise of the velocity in the samples, rad/s or m/s.
    pub(in crate::fit) velocity_noise: f64,
    /// Standard deviation of the filter, s; `None` where there is none.
    pub(in crate::fit) sigma_s: Option<f64>,
    /// Time by which the torque was recorded late, s, negative where early; it is put back in the samples.
    pub(in crate::fit) torque_delay_s: f64,
    /// Root mean square of what of it may be left in the samples, s.
    pub(in crate::fit) unknown_delay_s: f64,
    /// Whether the joint accelerates by no more than the noise, so that its inertia is left at zero.
    pub(in crate::fit) is_without_acceleration: bool,
    /// Why nothing can be locked; `None` where something is.
    pub(in crate::fit) repeats: Option<Repetition>,
}

/// # Errors
/// As [`fit`](crate::fit::fit).
pub(in crate::fit) fn gather(recordings: &[Recording], joint: &Joint, request: &Request) -> Result<Material> {
    let borrowed: Vec<&Recording> = recordings.iter().collect();
    for recording in recordings.iter().filter(|recording| recording.separated_friction().is_none()) {
        require_actuator(recording)?;
    }
    let planned = Preparation::plan(&borrowed, joint, request)?;
    let planned = thinned(&borrowed, &planned, MOST_SAMPLES);
    let delay = torque_delay(&borrowed, joint, &planned);
    let preparation = Preparation { torque_delay_s: delay.put_back_s, ..planned };
    let parts = recordings.iter().map(|recording| prepare(recording, &preparation)).collect::<Result<Vec<_>>>()?;
    let samples = Samples::join(parts)?;
    let velocity = samples.require_velocity()?.to_vec();
    let label = recordings.first().map_or("", |recording| recording.file());
    let first = velocity.first().copied().unwrap_or(0.0);
    if velocity.iter().all(|v| v.to_bits() == first.to_bits()) {
        return Err(Error::new(
            &codes::NO_MOTION,
            "the velocity is constant, so friction cannot be separated from an offset",
        )
        .in_file(label)
        .in_column("velocity")
        .with_value(first.to_string()));
    }
    let is_without_acceleration =
        joint.rigid_body.inertia_kgm2.is_none() && !accelerates(&samples, &velocity, preparation.acceleration_noise);
    let mut known = joint.clone();
    if is_without_acceleration {
        known.rigid_body.inertia_kgm2 = Some(0.0);
    }
    let joint = &known;
    let moving = if samples.friction.is_none() { moving(&velocity) } else { (0..velocity.len()).collect() };
    let stride = moving.len().div_ceil(MOST_ROWS).max(1);
    let moving: Vec<usize> = moving.into_iter().step_by(stride).collect();
    let (separation, states, target, friction) = match &samples.friction {
        Some(friction) => (None, None, friction.clone(), friction.clone()),
        None => {
            let states = states(recordings, &preparation, &samples, &moving)?;
            let separation = match &states {
                Some(states) => separate_averaged(&samples, joint, states),
                None => separate(&samples, joint),
            };
            let separation = separation.map_err(|error| error.in_file(label))?;
            let actuator = samples.actuator.as_deref().unwrap_or_default();
            let target = actuator.iter().zip(&separation.given).map(|(total, given)| total - given).collect();
            let friction = separation.friction.clone();
            (Some(separation), states, target, friction)
        }
    };
    let bend = separation.as_ref().map_or_else(|| vec![0.0; samples.len()], |separation| separation.bend.clone());
    let columns = separation.iter().flat_map(|s| &s.terms);
    let columns = columns.map(|term| RigidColumn { kind: term.kind, values: term.column.clone() }).collect();
    let rows = states.as_ref().map_or(moving, |states| states.rows.clone());
    let (correlation, cut) = cut(&samples, correlation_time(&friction, &samples.segments));
    let pieces = rows_of(&cut, &rows);
    let mut labels = vec![0; rows.len()];
    for (label, piece) in pieces.iter().enumerate() {
        labels[piece.clone()].fill(label);
    }
    let (turns, repeats) = turns::take(&samples, &rows, &pieces, correlation);
    let acceleration_noise = preparation.acceleration_noise;
    Ok(Material {
        samples,
        target,
        bend,
        states,
        friction,
        columns,
        separation,
        rows,
        stride,
        turns,
        labels,
        acceleration_noise,
        velocity_noise: preparation.velocity_noise(),
        sigma_s: preparation.sigma_s,
        torque_delay_s: delay.put_back_s,
        unknown_delay_s: delay.unknown_s,
        is_without_acceleration,
        repeats,
    })
}

/// Blocks that can be shared out, with the correlation time that they were cut by: a recording of few correlation times is
/// cut more finely than it should be, since with nothing held out nothing can be chosen.
fn cut(samples: &Samples, correlation: usize) -> (usize, Vec<Range<usize>>) {
    let found = blocks(samples, correlation);
    if found.len() >= LEAST_BLOCKS || correlation <= 1 { (correlation, found) } else { cut(samples, correlation / 2) }
}

/// Whether a joint accelerates by more than noise and rounding.
fn accelerates(samples: &Samples, velocity: &[f64], noise: f64) -> bool {
    let Some(acceleration) = samples.acceleration.as_deref() else { return false };
    let top = velocity.iter().fold(0.0_f64, |peak, v| peak.max(v.abs()));
    let rounding = ROUNDING * top * samples.rate_hz.unwrap_or(1.0);
    let power = acceleration.iter().map(|a| a * a).sum::<f64>() / acceleration.len().max(1) as f64;
    MOST_ATTENUATION * power > noise.powi(2) + rounding.powi(2)
}

fn require_actuator(recording: &Recording) -> Result<()> {
    use crate::recording::Quantity::{Current, Force, FrictionForce, FrictionTorque, Torque};
    recording.require(&[Torque, Force, Current, FrictionTorque, FrictionForce], "fitting friction").map(|_| ())
}

fn moving(velocity: &[f64]) -> Vec<usize> {
    let top = velocity.iter().fold(0.0_f64, |peak, v| peak.max(v.abs()));
    (0..velocity.len()).filter(|&row| velocity[row].abs() > REST_SHARE * top).collect()
}

/// Ranges of samples as ranges of positions in `rows`; those without a row are left out.
fn rows_of(pieces: &[Range<usize>], rows: &[usize]) -> Vec<Range<usize>> {
    pieces
        .iter()
        .map(|piece| rows.partition_point(|row| *row < piece.start)..rows.partition_point(|row| *row < piece.end))
        .filter(|range| !range.is_empty())
        .collect()
}

impl Material {
    /// What the law at the velocity of each row and the rigid body have to explain: the target without the bend and what friction adds that turns over
    /// before the velocity.
    pub(in crate::fit) fn target_at_velocity(&self) -> Vec<f64> {
        let lead = |row: usize| self.separation.as_ref().map_or(0.0, |separation| separation.lead[row]);
        self.rows.iter().map(|&row| self.target[row] - self.bend[row] - lead(row)).collect()
    }

    /// The values of a column at the rows that are learnt from.
    pub(in crate::fit) fn pick(&self, column: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|&row| column[row]).collect()
    }

    /// Columns that no part of law or rigid body stands for, with name and unit of their coefficient: what the torque's delay, as far as it is
    /// not known, makes of the rigid body; friction that turns over before the velocity; and what stiction makes of a reversal. A joint that stops for a moment within a sample is held by as much
    /// as its inertia would have taken, so that friction goes with the acceleration there.
    pub(in crate::fit) fn artefacts(&self) -> Vec<(&'static str, String, Vec<f64>)> {
        let unit = self.samples.actuator_unit;
        let mut artefacts = Vec::new();
        if let Some(rate) = self.rate_of_rigid_body().filter(|_| self.torque_delay_s != 0.0) {
            artefacts.push(("torque_advance", "s".to_owned(), rate));
        }
        if let Some(separation) = &self.separation {
            artefacts.push(("turn_over_lead", String::new(), self.pick(&separation.lead)));
        }
        if let Some((states, acceleration)) = self.states.as_ref().zip(self.samples.acceleration.as_deref()) {
            let held = states.turning.iter().zip(self.pick(acceleration)).map(|(turning, a)| turning * a).collect();
            artefacts.push(("stiction", format!("{unit} s2"), held));
        }
        artefacts.retain(|(_, _, column): &(_, _, Vec<f64>)| column.iter().any(|value| *value != 0.0));
        artefacts
    }

    /// How fast the torque of the rigid body changes at each row: what an advance of it would add. `None` of friction that was separated before.
    pub(in crate::fit) fn rate_of_rigid_body(&self) -> Option<Vec<f64>> {
        let separation = self.separation.as_ref()?;
        let period_s = self.samples.rate_hz.map_or(1.0, |rate| 1.0 / rate);
        Some(self.pick(&first_derivative(&separation.rigid_body, &self.samples.segments, period_s)))
    }
}
