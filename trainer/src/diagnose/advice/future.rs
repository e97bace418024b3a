//! The recording with a planned motion behind it: what every channel would show, as far as the recording itself tells.

use crate::actuator::{Actuator, Command, Commanded, Kind};
use crate::diagnose::advice::Candidate;
use crate::diagnose::measurement::signals::Signals;
use crate::numerics::derivatives::{first_derivative, second_derivative};
use crate::numerics::least_squares::{least_squares, weighted};
use crate::physics::JointState;
use std::ops::Range;

/// What is needed to continue a recording.
pub(crate) struct Future<'a> {
    signals: &'a Signals,
    /// Weights of [`load_columns`] for the typical load torque.
    load: Option<Vec<f64>>,
    /// Smallest and largest recorded payload as a share of the typical one.
    payload_range: (f64, f64),
    /// Weights of [`body_columns`] for the given rigid-body torque.
    body: Option<Vec<f64>>,
    /// Weights of sign, velocity and acceleration: the torque as far as a plan needs it.
    friction: Vec<f64>,
    sign_velocity: f64,
}

/// Share (0..1) of the energy of the load torque that its position has to explain, above which a payload can be
/// planned. Chosen by judgement: below it the load is no weight of a body at a place, and the planned load torque would
/// be wrong.
const LEAST_LOAD_ENERGY_SHARE: f64 = 0.9;
/// Difference of two payloads, over the usual one, below which they count as one. Chosen by judgement: a smaller one
/// plans motions that hardly differ, a larger one misses a payload that tells two effects apart.
const PAYLOAD_TOLERANCE: f64 = 0.1;
/// Longest rest that is proposed, s. Chosen by judgement: half an hour is what a person waits for; a joint with a
/// longer time constant does not cool down in it.
const LONGEST_REST_S: f64 = 1800.0;

impl<'a> Future<'a> {
    /// Learns what depends on the motion from the states of the recording.
    pub(crate) fn new(signals: &'a Signals, state: &JointState) -> Self {
        let all = [0..state.len()];
        let fit = |columns: &[Vec<f64>], target: &[f64]| least_squares(columns, target, &all);
        let mut future = Self {
            signals,
            load: None,
            payload_range: (1.0, 1.0),
            body: None,
            friction: vec![0.0; 3],
            sign_velocity: state.sign_velocity,
        };
        if let (Some(load), Some(_)) = (&state.load, &signals.load) {
            future.learn_load(load, &load_columns(&state.position, state.rotary), &state.segments);
        }
        if let Some(body) = &state.rigid_body {
            let load = future.load.as_ref().and(state.load.as_deref());
            future.body = fit(&body_columns(&state.position, &state.acceleration, load, state.rotary), body);
        }
        let rest: Vec<f64> = match &state.rigid_body {
            Some(body) => state.torque.iter().zip(body).map(|(t, b)| t - b).collect(),
            None => state.torque.clone(),
        };
        let columns = [state.sign.clone(), state.velocity.clone(), state.acceleration.clone()];
        future.friction = fit(&columns, &rest).unwrap_or(future.friction);
        future
    }

    /// The load torque over position, and how far the payloads of the segments differ.
    fn learn_load(&mut self, load: &[f64], columns: &[Vec<f64>], segments: &[Range<usize>]) {
        let Some(weights) = least_squares(columns, load, &[0..load.len()]) else { return };
        let typical = weighted(columns, &weights);
        let share = |run: Range<usize>| {
            let product: f64 = load[run.clone()].iter().zip(&typical[run.clone()]).map(|(l, t)| l * t).sum();
            product / typical[run].iter().map(|t| t * t).sum::<f64>().max(f64::MIN_POSITIVE)
        };
        let (mut low, mut high, mut rest, mut energy) = (f64::INFINITY, f64::NEG_INFINITY, 0.0, 0.0);
        for run in segments.iter().filter(|run| !run.is_empty()) {
            let payload = share(run.clone());
            (low, high) = (f64::min(low, payload), f64::max(high, payload));
            rest += run.clone().map(|i| (load[i] - payload * typical[i]).powi(2)).sum::<f64>();
            energy += load[run.clone()].iter().map(|l| l * l).sum::<f64>();
        }
        if energy > 0.0 && rest < (1.0 - LEAST_LOAD_ENERGY_SHARE) * energy {
            self.load = Some(weights);
            self.payload_range = (low, high);
        }
    }

    /// Payloads that can be planned, as shares of the typical one: none, the smallest and the largest that was recorded.
    pub(crate) fn payloads(&self) -> Vec<f64> {
        if self.load.is_none() {
            return Vec::new();
        }
        let mut payloads = vec![0.0, self.payload_range.0, self.payload_range.1];
        payloads.dedup_by(|a, b| (*a - *b).abs() < PAYLOAD_TOLERANCE);
        payloads
    }

    /// Rest in s after which the joint has cooled: three time constants of the recorded temperature, else as long as the
    /// recording.
    pub(crate) fn cooling_s(&self) -> f64 {
        let duration = self.signals.time.len() as f64 * self.signals.period;
        let constant =
            self.signals.temperature.as_deref().and_then(|series| thermal_time_constant(series, &self.signals.time));
        constant.map_or(duration, |constant| 3.0 * constant).clamp(60.0, LONGEST_REST_S)
    }

    /// Load torque along a planned motion.
    pub(crate) fn load(&self, candidate: &Candidate) -> Vec<f64> {
        let position = &candidate.excitation.position;
        let typical = match &self.load {
            Some(weights) => weighted(&load_columns(position, self.signals.rotary), weights),
            None => vec![self.signals.load.as_ref().and_then(|l| l.last()).copied().unwrap_or(0.0); position.len()],
        };
        let payload = candidate.payload.unwrap_or(1.0);
        typical.iter().map(|load| payload * load).collect()
    }

    /// The recording with the planned motion as its last segment.
    pub(crate) fn with(&self, candidate: &Candidate) -> Signals {
        let mut signals = self.signals.clone();
        let period = signals.period;
        let position = &candidate.excitation.position;
        let begin = signals.time.len();
        let count = position.len();
        let whole = [0..count];
        let velocity = first_derivative(position, &whole, period);
        let acceleration = second_derivative(position, &whole, period);
        let load = self.load(candidate);
        let body = match &self.body {
            Some(weights) => {
                let loaded = self.load.as_ref().map(|_| load.as_slice());
                weighted(&body_columns(position, &acceleration, loaded, signals.rotary), weights)
            }
            None => vec![0.0; count],
        };
        let start = signals.time.last().copied().unwrap_or(0.0) + candidate.rest_before_s.max(period);
        signals.time.extend((0..count).map(|k| start + k as f64 * period));
        signals.torque.extend((0..count).map(|k| {
            let sign = (velocity[k] / self.sign_velocity).tanh();
            body[k] + self.friction[0] * sign + self.friction[1] * velocity[k] + self.friction[2] * acceleration[k]
        }));
        signals.segments.push(begin..begin + count);
        if let Some(commanded) = &mut signals.commanded {
            // What the actuator will be told is not planned.
            let actuator = commanded.actuators.last().map_or(Actuator::ideal(Kind::Torque), |(_, actuator)| *actuator);
            commanded.append(Commanded::of(vec![Command::default(); count], actuator));
        }
        let extend = |series: &mut Option<Vec<f64>>, with: &[f64]| {
            if let Some(series) = series {
                series.extend_from_slice(with);
            }
        };
        extend(&mut signals.rigid_body, &body);
        extend(&mut signals.load, &load);
        extend(&mut signals.link_position, position);
        let temperature =
            signals.temperature.as_deref().map(|recorded| warmth(recorded, count, candidate.rest_before_s));
        extend(&mut signals.temperature, &temperature.unwrap_or_default());
        for series in &mut signals.other_positions {
            series.extend(std::iter::repeat_n(series.last().copied().unwrap_or(0.0), count));
        }
        signals.position.extend_from_slice(position);
        signals
    }
}

/// Temperature along a plan: after a rest it rises as it did at first, else it stays.
fn warmth(recorded: &[f64], count: usize, rest_before_s: f64) -> Vec<f64> {
    let last = recorded.last().copied().unwrap_or(0.0);
    (0..count).map(|k| if rest_before_s > 0.0 { recorded.get(k).copied().unwrap_or(last) } else { last }).collect()
}

fn load_columns(position: &[f64], rotary: bool) -> Vec<Vec<f64>> {
    if !rotary {
        return vec![vec![1.0; position.len()], position.to_vec()];
    }
    vec![position.iter().map(|q| q.sin()).collect(), position.iter().map(|q| q.cos()).collect()]
}

fn body_columns(position: &[f64], acceleration: &[f64], load: Option<&[f64]>, rotary: bool) -> Vec<Vec<f64>> {
    let mut columns = vec![acceleration.to_vec()];
    columns.extend(load.map(<[f64]>::to_vec));
    if load.is_none() {
        columns.push(vec![1.0; position.len()]);
        if rotary {
            columns.extend(load_columns(position, true));
        }
    }
    columns
}

/// Time constant in s of an exponential approach, by a scan over constants; `None` where the series does not change.
fn thermal_time_constant(series: &[f64], time: &[f64]) -> Option<f64> {
    // A slow channel: a few hundred values tell as much as all.
    let stride = (series.len() / 500).max(1);
    let sampled: Vec<(f64, f64)> = time.iter().copied().zip(series.iter().copied()).step_by(stride).collect();
    let (start, duration) = (sampled.first()?.0, sampled.last()?.0 - sampled.first()?.0);
    let target: Vec<f64> = sampled.iter().map(|(_, value)| *value).collect();
    let all = [0..target.len()];
    let rest = |constant: f64| {
        let approach = sampled.iter().map(|(t, _)| (-(t - start) / constant).exp()).collect();
        let columns = [vec![1.0; target.len()], approach];
        let weights = least_squares(&columns, &target, &all)?;
        let fitted = weighted(&columns, &weights);
        (weights[1] < 0.0).then(|| target.iter().zip(fitted).map(|(t, f)| (t - f).powi(2)).sum::<f64>())
    };
    (0..24)
        .map(|k| 0.03 * duration * 1.25f64.powi(k))
        .filter_map(|constant| Some((constant, rest(constant)?)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(constant, _)| constant)
}
