//! The recorded states at which every hypothesis evaluates its torque.

use super::EffectId;
use crate::actuator::Commanded;
use crate::numerics::between_samples::{mean_clamped, mean_tanh};
use crate::numerics::statistics::quantile;
use std::ops::Range;

/// States of one joint at the recording's own rate, all series of one length; SI units, joint side.
#[derive(Clone, Debug)]
pub struct JointState {
    /// Sample period in s.
    pub period: f64,
    /// Time in s.
    pub time: Vec<f64>,
    /// Position in rad or m.
    pub position: Vec<f64>,
    /// Velocity in rad/s or m/s.
    pub velocity: Vec<f64>,
    /// Acceleration in rad/s2 or m/s2.
    pub acceleration: Vec<f64>,
    /// Velocity below which the smoothed sign turns, in the unit of velocity.
    pub sign_velocity: f64,
    /// Time by which friction turns over before the velocity, s: that of a solver of constraints, zero for a joint.
    pub sign_lead_s: f64,
    /// Smoothed sign: the mean of `tanh(v / sign_velocity)` over the sample, of the velocity that is led.
    pub sign: Vec<f64>,
    /// Torque of the nominal rigid body in the unit of the actuator, where one is given.
    pub rigid_body: Option<Vec<f64>>,
    /// Torque transmitted through the gear (N m), where recorded or known from the rigid body.
    pub load: Option<Vec<f64>>,
    /// The part of the rigid body's torque that does not go with the acceleration, where a rigid body is given.
    pub gravity: Option<Vec<f64>>,
    /// Its change with the position in N m/rad; zero on a linear axis, and where it is not known.
    pub gravity_slope: Vec<f64>,
    /// Temperature in degrees Celsius, smoothed over seconds.
    pub temperature: Option<Vec<f64>>,
    /// Motion of the link, where a second encoder is fitted.
    pub link: Option<OtherJoint>,
    /// What the twist between both encoders shows.
    pub twist: Twist,
    /// Motions of other joints on the same clock.
    pub other_joints: Vec<OtherJoint>,
    /// Recorded actuator torque (N m, N or A), smoothed like the states.
    pub torque: Vec<f64>,
    /// Torque that the recording is compared with, nothing of it fitted to the recording: of a reference, or of a given rigid body.
    pub known: Option<Vec<f64>>,
    /// Torque that the base model predicts, in the unit of the actuator.
    pub predicted: Vec<f64>,
    /// Friction part of the base model, as pairs (velocity, torque) in ascending velocity, torque in the unit of the actuator.
    pub base_friction: Vec<(f64, f64)>,
    /// Stretches of uninterrupted time; memories restart at each.
    pub segments: Vec<Range<usize>>,
    /// Whether they are stretches of a motion that went on between them.
    pub is_excerpt: bool,
    /// Distance, time and dwell since the last reversal or stop.
    pub memory: MemoryAxes,
    /// What the actuator was told, where the torque is what it made of that.
    pub commanded: Option<Commanded>,
    /// Motor turns per joint turn, where known.
    pub gear_ratio: Option<f64>,
    /// Whether the axis turns (else it slides).
    pub rotary: bool,
    /// Resolution of the position, in its unit.
    pub resolution: f64,
}

/// What a second encoder tells of a transmission.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Twist {
    /// There is none, or the twist follows nothing that is known of a transmission.
    #[default]
    Unknown,
    /// The link moves with the motor.
    Rigid,
    /// The twist is that of one effect.
    Shows(EffectId),
}

/// Motion of another joint, or of the link behind the transmission.
#[derive(Clone, Debug)]
pub struct OtherJoint {
    /// Position in rad or m.
    pub position: Vec<f64>,
    /// Velocity in rad/s or m/s.
    pub velocity: Vec<f64>,
    /// Acceleration in rad/s2 or m/s2.
    pub acceleration: Vec<f64>,
}

/// What the contact may remember.
#[derive(Clone, Debug, Default)]
pub struct MemoryAxes {
    /// Distance travelled since the last change of direction, in rad or m.
    pub distance: Vec<f64>,
    /// Time since the last change of direction in s.
    pub elapsed: Vec<f64>,
    /// Length of the stop before the present motion in s (0 where it reversed without a stop).
    pub dwell: Vec<f64>,
    /// Distance travelled since the last stop or reversal.
    pub since_start: Vec<f64>,
    /// Whether the joint rests.
    pub at_rest: Vec<bool>,
}

impl MemoryAxes {
    /// Follows position and velocity; a joint rests while its speed stays below `rest_speed` for at least 20 ms.
    pub fn follow(position: &[f64], velocity: &[f64], segments: &[Range<usize>], period: f64, rest_speed: f64) -> Self {
        let count = position.len();
        let mut axes = Self {
            distance: vec![0.0; count],
            elapsed: vec![0.0; count],
            dwell: vec![0.0; count],
            since_start: vec![0.0; count],
            at_rest: vec![false; count],
        };
        let shortest_rest = (0.02 / period).ceil() as usize;
        for segment in segments {
            mark_rest(&velocity[segment.clone()], rest_speed, shortest_rest, &mut axes.at_rest[segment.clone()]);
            let mut direction = 0.0;
            let (mut distance, mut elapsed, mut dwell, mut rested, mut start) = (0.0, 0.0, 0.0, 0.0, 0.0);
            for i in segment.clone() {
                let step = if i > segment.start { (position[i] - position[i - 1]).abs() } else { 0.0 };
                if axes.at_rest[i] {
                    rested += period;
                } else {
                    if rested > 0.0 {
                        (dwell, start, rested) = (rested, 0.0, 0.0);
                    }
                    let heading = velocity[i].signum();
                    if velocity[i].abs() > 0.5 * rest_speed && heading != direction {
                        if direction != 0.0 && start > 20.0 * step.max(f64::MIN_POSITIVE) {
                            (dwell, start) = (0.0, 0.0);
                        }
                        (distance, elapsed, direction) = (0.0, 0.0, heading);
                    }
                    distance += step;
                    start += step;
                }
                elapsed += period;
                axes.distance[i] = distance;
                axes.elapsed[i] = elapsed;
                axes.dwell[i] = dwell;
                axes.since_start[i] = start;
            }
        }
        axes
    }
}

fn mark_rest(velocity: &[f64], rest_speed: f64, shortest: usize, at_rest: &mut [bool]) {
    let mut begin = 0;
    for i in 0..=velocity.len() {
        if i == velocity.len() || velocity[i].abs() >= rest_speed {
            if i - begin >= shortest {
                at_rest[begin..i].fill(true);
            }
            begin = i + 1;
        }
    }
}

impl JointState {
    /// Number of samples.
    pub fn len(&self) -> usize {
        self.time.len()
    }

    /// Whether there are no samples.
    pub fn is_empty(&self) -> bool {
        self.time.is_empty()
    }

    /// Largest speed that is common: the 98 % quantile of |v|.
    pub fn top_speed(&self) -> f64 {
        top_speed(&self.velocity)
    }

    /// Speed that samples show where the joint turns round: the median change of the velocity over a sample in which it turns; zero
    /// where it never does.
    pub fn resolved_speed(&self) -> f64 {
        let pairs = self.segments.iter().flat_map(|segment| self.velocity[segment.clone()].windows(2));
        quantile(pairs.filter(|pair| pair[0] * pair[1] < 0.0).map(|pair| (pair[1] - pair[0]).abs()), 0.5)
    }

    /// Travel between the 0.5 % and 99.5 % quantiles of position.
    pub fn travel(&self) -> (f64, f64) {
        (quantile(self.position.iter().copied(), 0.005), quantile(self.position.iter().copied(), 0.995))
    }

    /// Length of that.
    pub fn span(&self) -> f64 {
        let (low, high) = self.travel();
        high - low
    }

    /// Recorded duration in s, gaps left out, but of an excerpt all that it is taken from.
    pub fn duration(&self) -> f64 {
        match (self.time.first(), self.time.last()) {
            (Some(first), Some(last)) if self.is_excerpt => last - first,
            _ => self.len() as f64 * self.period,
        }
    }

    /// Friction of the base model at a velocity, held beyond the ends.
    pub fn base_friction_at(&self, velocity: f64) -> f64 {
        friction_at(&self.base_friction, velocity)
    }

    /// Central difference of a series, one-sided at the ends of a segment.
    pub fn rate_of(&self, series: &[f64]) -> Vec<f64> {
        let mut rate = vec![0.0; series.len()];
        for segment in &self.segments {
            let last = segment.end - 1;
            for i in segment.clone() {
                let (before, after) = (i.saturating_sub(1).max(segment.start), (i + 1).min(last));
                if after > before {
                    rate[i] = (series[after] - series[before]) / ((after - before) as f64 * self.period);
                }
            }
        }
        rate
    }

    /// Smoothed sign of a velocity, averaged over each sample with the velocity linear in between: the mean of tanh, so
    /// that a reversal between two samples is not rounded to one of them.
    pub fn averaged_sign(&self, velocity: &[f64], width: f64) -> Vec<f64> {
        self.over_samples(velocity, |before, here, after| {
            let (before, after) = (before / width, after / width);
            if (after - before).abs() < 1e-4 { (here / width).tanh() } else { mean_tanh(before, after) }
        })
    }

    /// The same of the velocity that the joint is about to have after a time (s).
    pub(crate) fn leading_sign(&self, lead_s: f64, width: f64) -> Vec<f64> {
        self.averaged_sign(&self.led_velocity(lead_s), width)
    }

    /// The same of a sign that turns over in a straight line, as constraints of solvers do up to their largest force.
    pub(crate) fn straight_sign(&self, lead_s: f64, width: f64) -> Vec<f64> {
        self.over_samples(&self.led_velocity(lead_s), |before, _, after| {
            mean_clamped(before.min(after), before.max(after), width)
        })
    }

    /// A value for each sample by the velocities half a sample before it, in it, and half a sample after it.
    fn over_samples(&self, velocity: &[f64], of: impl Fn(f64, f64, f64) -> f64) -> Vec<f64> {
        let mut values = vec![0.0; velocity.len()];
        for segment in &self.segments {
            let last = segment.end - 1;
            for i in segment.clone() {
                let before = 0.5 * (velocity[i] + velocity[i.saturating_sub(1).max(segment.start)]);
                let after = 0.5 * (velocity[i] + velocity[(i + 1).min(last)]);
                values[i] = of(before, velocity[i], after);
            }
        }
        values
    }

    /// Lets the smoothed sign turn below another velocity.
    pub(crate) fn turn_over_within(&mut self, velocity: f64) {
        self.turn_over_at(self.sign_lead_s, velocity);
    }

    /// Lets it turn below another velocity, and a time (s) before the velocity does.
    pub(crate) fn turn_over_at(&mut self, lead_s: f64, width: f64) {
        (self.sign_lead_s, self.sign_velocity) = (lead_s, width);
        self.sign = self.leading_sign(lead_s, width);
    }

    /// The velocity that the joint is about to have after a time (s) at its acceleration; at rest it has none, and its acceleration is noise.
    pub(crate) fn led_velocity(&self, lead_s: f64) -> Vec<f64> {
        let rests = |i: usize| self.memory.at_rest.get(i).copied().unwrap_or(false);
        self.map(|i| self.velocity[i] + if rests(i) { 0.0 } else { lead_s * self.acceleration[i] })
    }

    /// One value a sample.
    pub fn map(&self, torque: impl Fn(usize) -> f64) -> Vec<f64> {
        (0..self.len()).map(torque).collect()
    }
}

/// Friction at a velocity from pairs (velocity, torque) in ascending velocity, held beyond the ends.
pub(crate) fn friction_at(table: &[(f64, f64)], velocity: f64) -> f64 {
    let after = table.partition_point(|(v, _)| *v < velocity);
    match (after.checked_sub(1).and_then(|i| table.get(i)), table.get(after)) {
        (Some(&(v0, f0)), Some(&(v1, f1))) => f0 + (f1 - f0) * (velocity - v0) / (v1 - v0),
        (Some(&(_, f)), None) | (None, Some(&(_, f))) => f,
        (None, None) => 0.0,
    }
}

/// Speed that all but a fiftieth of the samples stay below.
pub(crate) fn top_speed(velocity: &[f64]) -> f64 {
    quantile(velocity.iter().map(|v| v.abs()), 0.98)
}
