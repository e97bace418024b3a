//! From signals to states and working rows behind a given filter: one filter for all channels, rest and edges left out, blocks set
//! aside.

use crate::diagnose::measurement::signals::Signals;
use crate::diagnose::preparation::commanded_noise::commanded_noise;
use crate::diagnose::preparation::gravity::{gravity_of_body, slope_of_gravity, torques_of_position, without_inertia};
use crate::diagnose::preparation::rows::{Block, Division, Lock, divide, hesitation, standstill};
use crate::diagnose::preparation::sampling_jitter::sampling_jitter;
use crate::diagnose::preparation::two_encoders::shown_by_twist;
use crate::numerics::derivatives::{first_derivative, second_derivative};
use crate::numerics::filter::windowed_sinc::ZeroPhase;
use crate::numerics::least_squares::least_squares;
use crate::numerics::statistics::{DEVIATION_PER_MEDIAN, quantile};
use crate::physics::{JointState, MemoryAxes, OtherJoint, Twist, top_speed};
use std::ops::Range;

/// States at the recording's rate and the rows on which evidence is weighed.
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The states.
    pub state: JointState,
    /// The common filter F.
    pub filter: ZeroPhase,
    /// The filter before the motion.
    pub(crate) motion_filter: ZeroPhase,
    /// Whether a wider filter was refused for the errors of the position.
    pub quantisation_limited: bool,
    /// Standard deviation of the instants at which the position was sampled, s.
    pub(crate) sampling_jitter: f64,
    /// Sample index of each working row.
    pub rows: Vec<usize>,
    /// Blocks of rows.
    pub blocks: Vec<Block>,
    /// Sample ranges that no row is taken from: they decide nothing, and what is told of the written model is computed on them.
    pub sealed: Vec<Range<usize>>,
    /// Width of the smoothed sign that the recording resolves.
    pub(crate) sharp_sign_velocity: f64,
    /// Velocity behind a narrower filter, for the nuisance columns of the differentiation bias.
    pub narrow_velocity: Vec<f64>,
    /// Acceleration behind a narrower filter.
    pub narrow_acceleration: Vec<f64>,
    /// Recorded torque less the nominal rigid body or the reference, unfiltered: what the friction has to explain.
    pub friction_torque: Vec<f64>,
    /// Recorded torque, unfiltered.
    pub torque: Vec<f64>,
}

/// What of the recorded torque needs no identification, and where nothing is compared.
#[derive(Clone, Copy, Debug, Default)]
pub struct Known<'a> {
    /// Known torque at every sample, in the unit of the actuator.
    pub torque: Option<&'a [f64]>,
    /// Samples beyond what a law was fitted on; empty where all are within.
    pub outside: &'a [bool],
}

impl<'a> Known<'a> {
    /// The rigid body of a recording.
    pub fn of(signals: &'a Signals) -> Self {
        Self { torque: signals.rigid_body.as_deref(), outside: &[] }
    }
}

/// Least width of the smoothed sign over the top speed. Chosen by judgement: an eighth of the narrowest Stribeck
/// velocity that is looked for; a wider sign takes up break-away, a narrower one jumps between two samples.
const SIGN_WIDTH_SHARE: f64 = 0.001;
/// Cut-offs before the motion over the common one, widest first; the first whose noise is small is taken, so that a
/// reversal stays as sharp as the encoder allows. Down to that of the other channels. Chosen by judgement: steps of
/// about 1.6.
const MOTION_FILTER_RATIOS: [f64; 3] = [4.0, 2.5, CHANNEL_FILTER_RATIO];
/// Cut-off of the filter before the other channels over the common one: just beyond the end of the common transition
/// (one and a half times its cut-off), so that the common filter decides the band.
const CHANNEL_FILTER_RATIO: f64 = 1.6;
/// Largest cut-off of any filter, cycles a sample: its transition, one and a half times as far, then ends at the
/// Nyquist frequency.
const WIDEST_CYCLES_PER_SAMPLE: f64 = 0.35;
/// Cut-off of the nuisance column of the sign over that before the motion. Chosen by judgement: the change of the sign
/// with the filter carries the bias of differentiation; nearer to one the column vanishes, smaller takes up presliding.
const NARROW_VELOCITY_RATIO: f64 = 0.4;
/// The same of the acceleration over the common cut-off. Chosen by judgement: nearer to one the column vanishes,
/// smaller takes up what rings behind an elastic gear.
const NARROW_ACCELERATION_RATIO: f64 = 0.8;

impl Prepared {
    /// Prepares states and rows behind a given cut-off in Hz.
    pub(crate) fn at_cut_off(signals: &Signals, cut_off: f64, known: Known, lock: Lock) -> Self {
        Self::under_noise(signals, cut_off, commanded_noise(signals), known, lock)
    }

    /// The same where the [`commanded_noise`] of the position is known.
    pub(super) fn under_noise(signals: &Signals, cut_off: f64, noise: f64, known: Known, lock: Lock) -> Self {
        let period = signals.period;
        let segments = &signals.segments;
        let filter = ZeroPhase::new(cut_off, period);
        let channels = channel_filter(cut_off, period);
        let (states, Motion { position, velocity, acceleration }) = sharpest_motion(signals, cut_off);
        let narrow =
            |cut_off: f64| Motion::behind(&ZeroPhase::new(cut_off, period), &signals.position, segments, period);
        let narrow_velocity = narrow(NARROW_VELOCITY_RATIO * states.cut_off_hz).velocity;
        let narrow_acceleration = narrow(NARROW_ACCELERATION_RATIO * cut_off).acceleration;
        let steps = signals.position_resolution / 12f64.sqrt();
        let velocity_noise = velocity_noise(steps.hypot(noise), &states, period);
        let other_motion = |series: &[f64]| {
            let Motion { position, velocity, acceleration } = Motion::behind(&states, series, segments, period);
            OtherJoint { position, velocity, acceleration }
        };
        let mut state = JointState {
            period,
            time: signals.time.clone(),
            position,
            velocity,
            acceleration,
            sign_velocity: 0.0,
            sign_lead_s: 0.0,
            sign: Vec::new(),
            rigid_body: signals.rigid_body.as_ref().map(|series| channels.over(series, segments)),
            load: signals.load.as_ref().or(signals.rigid_body.as_ref()).map(|series| channels.over(series, segments)),
            gravity: None,
            gravity_slope: Vec::new(),
            temperature: signals.temperature.as_ref().map(|series| slow(series, &signals.time, period)),
            link: signals.link_position.as_ref().map(|series| other_motion(series)),
            twist: Twist::Unknown,
            other_joints: signals.other_positions.iter().map(|series| other_motion(series)).collect(),
            torque: channels.over(&signals.torque, segments),
            known: None,
            predicted: Vec::new(),
            base_friction: Vec::new(),
            segments: segments.clone(),
            is_excerpt: signals.is_excerpt,
            memory: MemoryAxes::default(),
            commanded: signals.commanded.clone(),
            gear_ratio: signals.gear_ratio,
            rotary: signals.rotary,
            resolution: signals.position_resolution,
        };
        let resolved_width = (4.0 * velocity_noise).max(SIGN_WIDTH_SHARE * state.top_speed());
        let sharp_sign_velocity = resolved_width.max(f64::MIN_POSITIVE);
        state.turn_over_within(sharp_sign_velocity);
        state.memory =
            MemoryAxes::follow(&state.position, &state.velocity, segments, period, 0.5 * state.sign_velocity);
        state.gravity = match &signals.load {
            // What a commanded joint carries is weighed, and has its inertia in it.
            Some(_) if state.commanded.is_some() => {
                state.load.as_ref().and_then(|load| without_inertia(&state, load)).or_else(|| state.load.clone())
            }
            Some(_) => state.load.clone(),
            None => gravity_of_body(&state),
        };
        state.gravity_slope = slope_of_gravity(&state);
        state.twist = shown_by_twist(&state);
        let friction_torque = match known.torque {
            Some(known) => signals.torque.iter().zip(known).map(|(t, k)| t - k).collect(),
            None => signals.torque.clone(),
        };
        let unsure = hesitation(&state.velocity, state.sign_velocity, segments);
        let mut left_out: Vec<bool> = standstill(signals, state.top_speed())
            .into_iter()
            .zip(unsure)
            .map(|(stuck, unsure)| stuck || unsure)
            .collect();
        left_out.iter_mut().zip(known.outside).for_each(|(left_out, outside)| *left_out |= outside);
        let Division { rows, blocks, sealed } = divide(&state, &left_out, &filter, lock);
        Self {
            sampling_jitter: sampling_jitter(signals, &state),
            state,
            filter,
            motion_filter: states,
            quantisation_limited: false,
            rows,
            blocks,
            sealed,
            sharp_sign_velocity,
            narrow_velocity,
            narrow_acceleration,
            friction_torque,
            torque: signals.torque.clone(),
        }
    }

    /// A series behind the common filter, one value a working row.
    pub fn filtered(&self, series: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|&i| self.filter.at(series, i)).collect()
    }

    /// Several series behind it.
    pub(crate) fn filtered_all(&self, series: &[Vec<f64>]) -> Vec<Vec<f64>> {
        series.iter().map(|series| self.filtered(series)).collect()
    }

    /// Whether friction turns over as sharply as the recording resolves, and not as it shows.
    pub(crate) fn turns_over_sharply(&self) -> bool {
        self.state.sign_velocity <= self.sharp_sign_velocity
    }

    /// A series at the working rows, unfiltered.
    pub fn at_rows(&self, series: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|&i| series[i]).collect()
    }

    /// Whether nothing of friction that turns over enters a row: the joint is faster than the noise of its velocity within half of
    /// the filter's reach.
    pub(crate) fn sign_is_sure(&self) -> Vec<bool> {
        let (half, velocity) = (self.filter.reach() / 2, &self.state.velocity);
        let is_fast = |velocity: &f64| velocity.abs() > self.state.sign_velocity;
        self.rows.iter().map(|&i| velocity[i - half..=i + half].iter().all(is_fast)).collect()
    }

    /// The part of a stretch of time (s) that open rows show, half of the filter's reach beyond the first and the last of them.
    pub(crate) fn shown_by_open_rows(&self, [from, to]: [f64; 2]) -> [f64; 2] {
        let reach = 0.5 * self.filter.reach() as f64 * self.state.period;
        let times = self.open_runs().into_iter().flatten().map(|row| self.state.time[self.rows[row]]);
        let (mut first, mut last) = (f64::INFINITY, f64::NEG_INFINITY);
        for time in times.filter(|time| (from..to).contains(time)) {
            (first, last) = (first.min(time), last.max(time));
        }
        if first > last { [from, to] } else { [from.max(first - reach), to.min(last + reach)] }
    }

    /// The states had `position` and `torque` been recorded, behind the same filters.
    pub(crate) fn state_at(&self, position: &[f64], torque: &[f64]) -> JointState {
        let JointState { period, segments, sign_velocity, .. } = &self.state;
        let Motion { position, velocity, acceleration } =
            Motion::behind(&self.motion_filter, position, segments, *period);
        let sign = self.state.averaged_sign(&velocity, *sign_velocity);
        let torque = channel_filter(self.filter.cut_off_hz, *period).over(torque, segments);
        JointState { position, velocity, acceleration, sign, torque, ..self.state.clone() }
    }

    /// Runs of rows that take part in fitting and choosing.
    pub fn open_runs(&self) -> Vec<Range<usize>> {
        self.open_blocks().concat()
    }

    /// The same block by block.
    pub(crate) fn open_blocks(&self) -> Vec<Vec<Range<usize>>> {
        self.blocks.iter().filter(|block| !block.locked).map(|block| block.runs.clone()).collect()
    }

    /// Sealed stretches of the recording, from and to in s.
    pub(crate) fn sealed_s(&self) -> Vec<[f64; 2]> {
        let time = |sample: usize| self.state.time[sample];
        let stretches = self.sealed.iter().filter(|range| !range.is_empty());
        stretches.map(|range| [time(range.start), time(range.end - 1)]).collect()
    }

    /// Runs of the locked blocks.
    pub fn locked_runs(&self) -> Vec<Range<usize>> {
        self.blocks.iter().filter(|block| block.locked).flat_map(|block| block.runs.clone()).collect()
    }
}

/// The filter before all channels but the motion.
pub(crate) fn channel_filter(cut_off: f64, period: f64) -> ZeroPhase {
    ZeroPhase::new((CHANNEL_FILTER_RATIO * cut_off).min(WIDEST_CYCLES_PER_SAMPLE / period), period)
}

/// Position, velocity and acceleration behind one filter.
struct Motion {
    position: Vec<f64>,
    velocity: Vec<f64>,
    acceleration: Vec<f64>,
}

impl Motion {
    fn behind(filter: &ZeroPhase, position: &[f64], segments: &[Range<usize>], period: f64) -> Self {
        let position = filter.over(position, segments);
        let velocity = first_derivative(&position, segments, period);
        let acceleration = second_derivative(&position, segments, period);
        Self { position, velocity, acceleration }
    }
}

/// Motion behind the widest filter behind which four deviations of the velocity's noise stay within the width of the smoothed
/// sign. A wider filter adds noise alone at most samples, so that the median tells its deviation.
fn sharpest_motion(signals: &Signals, cut_off: f64) -> (ZeroPhase, Motion) {
    let behind = |width: f64| {
        let filter = ZeroPhase::new((width * cut_off).min(WIDEST_CYCLES_PER_SAMPLE / signals.period), signals.period);
        let motion = Motion::behind(&filter, &signals.position, &signals.segments, signals.period);
        (filter, motion)
    };
    let [wider @ .., narrowest] = MOTION_FILTER_RATIOS;
    let smoothest = behind(narrowest);
    let smooth = &smoothest.1.velocity;
    let allowed = SIGN_WIDTH_SHARE * top_speed(smooth);
    let is_quiet = |(_, motion): &(ZeroPhase, Motion)| {
        let added = quantile(motion.velocity.iter().zip(smooth).map(|(wide, smooth)| (wide - smooth).abs()), 0.5);
        4.0 * DEVIATION_PER_MEDIAN * added <= allowed
    };
    wider.into_iter().map(behind).find(is_quiet).unwrap_or(smoothest)
}

/// Deviation of the derived velocity by a white error of the position of some deviation.
fn velocity_noise(error: f64, filter: &ZeroPhase, period: f64) -> f64 {
    // A derivative at the cut-off: white noise through a low-pass of bandwidth f has the share 2 f dt.
    let bandwidth = filter.cut_off_hz;
    error * std::f64::consts::TAU * bandwidth * (2.0 * bandwidth * period / 3.0).sqrt()
}

/// Smooths a slow channel by a straight line over four seconds to each side, so that its noise and its steps do not hand
/// the evidence to a rival; a pause of the clock ends the line.
fn slow(series: &[f64], time: &[f64], period: f64) -> Vec<f64> {
    /// Half length of the straight lines, s. Chosen by judgement: temperatures move over minutes and are recorded in
    /// steps of half a kelvin; shorter hands the evidence of a coarse sensor to warm-up, longer flattens a fast motor's
    /// winding.
    const TEMPERATURE_REACH_S: f64 = 4.0;
    let mut smooth = Vec::with_capacity(series.len());
    for piece in time.chunk_by(|a, b| b - a < 1.5 * period) {
        let (begin, origin) = (smooth.len(), piece[0]);
        // Sums of 1, t, t^2, y and t y up to each sample.
        let mut sums = vec![[0.0; 5]];
        for (i, t) in piece.iter().enumerate() {
            let (t, y, before) = (t - origin, series[begin + i], sums[i]);
            let terms = [1.0, t, t * t, y, t * y];
            sums.push(std::array::from_fn(|k| before[k] + terms[k]));
        }
        smooth.extend(piece.iter().map(|&now| {
            let low = piece.partition_point(|t| *t < now - TEMPERATURE_REACH_S);
            let high = piece.partition_point(|t| *t <= now + TEMPERATURE_REACH_S);
            let [n, t, tt, y, ty]: [f64; 5] = std::array::from_fn(|k| sums[high][k] - sums[low][k]);
            let spread = tt - t * t / n;
            let slope = if spread > 1e-9 * tt { (ty - t * y / n) / spread } else { 0.0 };
            y / n + slope * (now - origin - t / n)
        }));
    }
    smooth
}

/// Filtered Coulomb and viscous friction, inertia and offset.
pub(crate) fn simplest_model(prepared: &Prepared) -> Vec<Vec<f64>> {
    let state = &prepared.state;
    [&state.sign, &state.velocity, &state.acceleration, &vec![1.0; state.len()]]
        .into_iter()
        .map(|series| prepared.filtered(series))
        .collect()
}

/// Torque per acceleration that the recording shows beside gravity or a spring; `None` where it shows none.
pub(crate) fn identified_inertia(prepared: &Prepared) -> Option<f64> {
    let state = &prepared.state;
    let mut columns = simplest_model(prepared);
    columns.extend(prepared.filtered_all(&torques_of_position(state)));
    let torque = prepared.filtered(&prepared.torque);
    least_squares(&columns, &torque, &prepared.open_runs()).map(|coefficients| coefficients[2])
}
