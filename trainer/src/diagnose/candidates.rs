//! Every hypothesis as filtered columns: the named effects of the catalogue and the generic rivals.

use super::prepare::Prepared;
use crate::physics::{EffectId, Hypothesis, JointState, Shape};
use rayon::prelude::*;
use std::ops::Range;

/// What a group of columns stands for.
#[derive(Clone, Debug, PartialEq)]
pub enum Label {
    /// An effect of the catalogue, by its place in it.
    Named(EffectId),
    /// An unnamed structure: a factor of velocity times a function of a channel.
    Generic(Generic),
}

impl std::fmt::Display for Label {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Label::Named(effect) => f.write_str(effect.name()),
            Label::Generic(rival) => write!(f, "{} c({})", rival.factor.text(), rival.channel.name()),
        }
    }
}

/// A generic rival: `factor(v) * c(channel)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Generic {
    /// Factor of velocity.
    pub factor: Factor,
    /// Channel on which it depends.
    pub channel: Channel,
}

impl Generic {
    /// Orders of its cosine series.
    fn orders(self) -> [usize; 2] {
        match (self.factor, self.channel) {
            (Factor::Sign, Channel::Position) => [GENERIC_ORDERS[0], NARROW_ORDER],
            _ => GENERIC_ORDERS,
        }
    }

    /// Whether the catalogue has a name for it: broad functions of position that turn with the direction are
    /// position-dependent friction.
    fn has_a_name(self, order: usize) -> bool {
        self.factor == Factor::Sign && self.channel == Channel::Position && order == GENERIC_ORDERS[0]
    }
}

/// Factor of velocity in a generic rival.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Factor {
    /// The smoothed sign: a friction.
    Sign,
    /// Velocity: a viscous friction.
    Velocity,
    /// One: a torque that does not turn with the direction.
    One,
    /// The square of velocity: a centrifugal torque.
    VelocitySquared,
}

impl Factor {
    /// How the factor reads in an equation.
    pub fn text(self) -> &'static str {
        match self {
            Factor::Sign => "tanh(v/v_eps)",
            Factor::Velocity => "v",
            Factor::One => "1",
            Factor::VelocitySquared => "v^2",
        }
    }
}

/// Channel or derived axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Channel {
    /// Position.
    Position,
    /// Speed |v|.
    Speed,
    /// Transmitted load.
    Load,
    /// Temperature.
    Temperature,
    /// Time.
    Time,
    /// Acceleration.
    Acceleration,
    /// Distance since the last reversal.
    DistanceSinceReversal,
    /// Time since the last reversal.
    TimeSinceReversal,
    /// Length of the stop before the present motion.
    Dwell,
    /// Velocity of another joint.
    OtherJoint(usize),
    /// Position of another joint.
    OtherPosition(usize),
}

impl Channel {
    /// The name that reports and scripts see.
    pub fn name(self) -> &'static str {
        match self {
            Channel::Position => "position",
            Channel::Speed => "velocity",
            Channel::Load => "load",
            Channel::Temperature => "temperature",
            Channel::Time => "time",
            Channel::Acceleration => "acceleration",
            Channel::DistanceSinceReversal => "distance_since_reversal",
            Channel::TimeSinceReversal => "time_since_reversal",
            Channel::Dwell => "dwell",
            Channel::OtherJoint(_) => "other_velocity",
            Channel::OtherPosition(_) => "other_position",
        }
    }

    /// The axes along which a finding is located, velocity apart: it keeps its sign there.
    pub fn axes(state: &JointState) -> Vec<Channel> {
        let mut axes = vec![
            Channel::Position,
            Channel::Load,
            Channel::Temperature,
            Channel::Acceleration,
            Channel::DistanceSinceReversal,
            Channel::TimeSinceReversal,
            Channel::Dwell,
            Channel::Time,
        ];
        axes.extend((0..state.other_joints.len()).map(Channel::OtherJoint));
        axes
    }

    /// The series of this channel, where the recording has it.
    pub fn series(self, state: &JointState) -> Option<Vec<f64>> {
        match self {
            Channel::Position => Some(state.position.clone()),
            Channel::Speed => Some(state.velocity.iter().map(|v| v.abs()).collect()),
            Channel::Load => state.load.clone(),
            Channel::Temperature => state.temperature.clone(),
            Channel::Time => Some(state.time.clone()),
            Channel::Acceleration => Some(state.acceleration.clone()),
            Channel::DistanceSinceReversal => Some(state.memory.distance.clone()),
            Channel::TimeSinceReversal => Some(state.memory.elapsed.clone()),
            Channel::Dwell => Some(state.memory.dwell.clone()),
            Channel::OtherJoint(joint) => state.other_joints.get(joint).map(|other| other.velocity.clone()),
            Channel::OtherPosition(joint) => state.other_joints.get(joint).map(|other| other.position.clone()),
        }
    }
}

/// Orders of the cosine series of a generic rival.
const GENERIC_ORDERS: [usize; 2] = [3, 12];
/// Order for position, where a narrow place matters.
const NARROW_ORDER: usize = 20;

/// One shape of a group and the columns that it occupies.
#[derive(Clone, Debug)]
pub struct Variant {
    /// Shape parameters (for a generic rival: the order of its series).
    pub shape: Shape,
    /// Columns of the design.
    pub columns: Range<usize>,
}

/// A hypothesis with all its variants.
#[derive(Clone, Debug)]
pub struct Group {
    /// What it stands for.
    pub label: Label,
    /// Its shapes.
    pub variants: Vec<Variant>,
}

/// Every hypothesis that this recording can show, filtered, one value a working row, scaled to unit root mean square.
#[derive(Clone, Debug)]
pub struct Design {
    /// Filtered columns.
    pub columns: Vec<Vec<f64>>,
    /// Groups of columns.
    pub groups: Vec<Group>,
}

impl Design {
    /// Builds the columns of the given hypotheses and of the generic rivals.
    pub fn new(prepared: &Prepared, hypotheses: &[Box<dyn Hypothesis + Send>], left_out: &[EffectId]) -> Self {
        let state = &prepared.state;
        let mut jobs: Vec<(Label, Shape, usize)> = Vec::new();
        for (index, hypothesis) in hypotheses.iter().enumerate().filter(|(_, h)| !left_out.contains(&h.id())) {
            jobs.extend(
                hypothesis.shapes(state).into_iter().map(|shape| (Label::Named(hypothesis.id()), shape, index)),
            );
        }
        let built: Vec<Vec<Vec<f64>>> = jobs
            .par_iter()
            .map(|(_, shape, index)| {
                hypotheses[*index].columns(state, shape).iter().map(|raw| prepared.filtered(raw)).collect()
            })
            .collect();
        let mut design = Self { columns: Vec::new(), groups: Vec::new() };
        for ((label, shape, _), columns) in jobs.into_iter().zip(built) {
            if columns.is_empty() {
                continue;
            }
            let begin = design.columns.len();
            design.columns.extend(columns);
            let variant = Variant { shape, columns: begin..design.columns.len() };
            match design.groups.last_mut().filter(|group| group.label == label) {
                Some(group) => group.variants.push(variant),
                None => design.groups.push(Group { label, variants: vec![variant] }),
            }
        }
        design.add_generic_rivals(prepared);
        let runs = prepared.open_runs();
        design.columns.par_iter_mut().for_each(|column| {
            let energy = super::linear::dot(column, column, &runs);
            if energy > 0.0 && energy.is_finite() {
                let count: usize = runs.iter().map(|run| run.len()).sum();
                let scale = (count as f64 / energy).sqrt();
                column.iter_mut().for_each(|v| *v *= scale);
            } else {
                column.fill(0.0);
            }
        });
        design
    }

    fn add_generic_rivals(&mut self, prepared: &Prepared) {
        let rivals = generic_rivals(&prepared.state);
        let built: Vec<Vec<Vec<f64>>> = rivals
            .par_iter()
            .map(|rival| {
                generic_columns(&prepared.state, *rival, rival.orders()[1])
                    .iter()
                    .map(|raw| prepared.filtered(raw))
                    .collect()
            })
            .collect();
        for (rival, columns) in rivals.into_iter().zip(built) {
            let begin = self.columns.len();
            self.columns.extend(columns);
            let variants = rival
                .orders()
                .into_iter()
                .filter(|order| !rival.has_a_name(*order))
                .map(|order| Variant { shape: vec![order as f64], columns: begin..begin + order })
                .collect();
            self.groups.push(Group { label: Label::Generic(rival), variants });
        }
    }
}

/// The generic rivals that the channels allow.
pub(crate) fn generic_rivals(state: &JointState) -> Vec<Generic> {
    let mut rivals = Vec::new();
    let mut add = |factors: &[Factor], channel: Channel| {
        let Some(series) = channel.series(state) else { return };
        let (low, high) = series.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
        if high > low {
            rivals.extend(factors.iter().map(|&factor| Generic { factor, channel }));
        }
    };
    let all = [Factor::Sign, Factor::Velocity, Factor::One];
    for channel in [Channel::Position, Channel::Load, Channel::Temperature, Channel::Time, Channel::Acceleration] {
        add(&all, channel);
    }
    add(&[Factor::VelocitySquared], Channel::Position);
    add(&[Factor::Sign, Factor::One], Channel::Speed);
    add(&[Factor::Sign], Channel::DistanceSinceReversal);
    add(&[Factor::Sign], Channel::TimeSinceReversal);
    for joint in 0..state.other_joints.len() {
        add(&all, Channel::OtherJoint(joint));
        add(&all, Channel::OtherPosition(joint));
    }
    rivals
}

/// Cosine series of the rank-transformed channel times the factor, at the recording's rate.
pub(crate) fn generic_columns(state: &JointState, rival: Generic, order: usize) -> Vec<Vec<f64>> {
    let Some(series) = rival.channel.series(state) else { return Vec::new() };
    let rank = rank_transform(&series);
    let factor: Vec<f64> = match rival.factor {
        Factor::Sign => state.sign.clone(),
        Factor::Velocity => state.velocity.clone(),
        Factor::One => vec![1.0; state.len()],
        Factor::VelocitySquared => state.velocity.iter().map(|v| v * v).collect(),
    };
    // cos(j x) by the Chebyshev recurrence.
    let base: Vec<f64> = rank.iter().map(|u| (std::f64::consts::PI * u).cos()).collect();
    let mut columns: Vec<Vec<f64>> = vec![factor.clone(), base.iter().zip(&factor).map(|(c, f)| c * f).collect()];
    for j in 2..=order {
        let next = (0..state.len()).map(|i| 2.0 * base[i] * columns[j - 1][i] - columns[j - 2][i]).collect();
        columns.push(next);
    }
    columns.split_off(1)
}

/// Rank of each value among 512 quantiles of the series, interpolated, in [0, 1].
fn rank_transform(series: &[f64]) -> Vec<f64> {
    const QUANTILES: usize = 512;
    let mut sorted = series.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let last = sorted.len() - 1;
    let knots: Vec<f64> = (0..=QUANTILES).map(|k| sorted[last * k / QUANTILES]).collect();
    series
        .iter()
        .map(|value| {
            let below = knots.partition_point(|knot| knot < value);
            let above = knots.partition_point(|knot| knot <= value);
            if above > below {
                return 0.5 * (below + above - 1) as f64 / QUANTILES as f64;
            }
            if below == 0 || below > QUANTILES {
                return below.min(QUANTILES) as f64 / QUANTILES as f64;
            }
            let share = (value - knots[below - 1]) / (knots[below] - knots[below - 1]);
            ((below - 1) as f64 + share) / QUANTILES as f64
        })
        .collect()
}
