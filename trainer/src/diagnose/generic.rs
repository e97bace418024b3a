//! Structures without a name: a factor of velocity times a free function of a channel.

use crate::physics::{JointState, Shape};

/// A generic rival: `factor(v) * c(channel)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Generic {
    /// Factor of velocity.
    pub factor: Factor,
    /// Channel on which it depends.
    pub channel: Channel,
}

impl Generic {
    /// Shapes of its cosine series: order, and strength of the prior (0 for none).
    pub(super) fn shapes(self) -> Vec<Shape> {
        let most = match (self.factor, self.channel) {
            (Factor::Sign, Channel::Position) => NARROW_ORDER,
            _ => GENERIC_ORDERS[1],
        };
        let free = [GENERIC_ORDERS[0], most].map(|order| vec![order as f64, 0.0]);
        let smooth = PRIOR_STRENGTHS.map(|strength| vec![most as f64, strength]);
        free.into_iter().chain(smooth).filter(|shape| !self.has_a_name(shape)).collect()
    }

    /// Prior precision of each coefficient over what all rows tell of it: that of a smooth function for a series with a prior,
    /// none for another one.
    pub(super) fn ridge(self, shape: &[f64]) -> Vec<f64> {
        if shape[1] == 0.0 {
            return Vec::new();
        }
        let orders = self.factor.first_order()..=shape[0] as usize;
        orders.map(|j| if j == 0 { UNIT_INFORMATION } else { (j * j) as f64 / shape[1] }).collect()
    }

    /// Largest order of its series.
    pub(super) fn longest(self) -> usize {
        self.shapes().iter().map(|shape| shape[0] as usize).max().unwrap_or(0)
    }

    /// Columns of a series up to an order.
    pub(super) fn width(self, order: usize) -> usize {
        order + 1 - self.factor.first_order()
    }

    /// Whether the catalogue has a name for it: broad functions of position that turn with the direction are
    /// position-dependent friction, broad functions of speed that do not are an asymmetry.
    fn has_a_name(self, shape: &[f64]) -> bool {
        let broad = shape[0] == GENERIC_ORDERS[0] as f64 && shape[1] == 0.0;
        match (self.factor, self.channel) {
            (Factor::Sign, Channel::Position) => broad,
            (Factor::One, Channel::Speed) => broad || (shape[1] > 0.0 && shape[1] < PRIOR_STRENGTHS[2]),
            _ => false,
        }
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
    /// The magnitude of the load times the smoothed sign: a load-dependent friction.
    LoadSign,
}

impl Factor {
    /// First order of the series: 0 where the base does not hold the factor itself.
    fn first_order(self) -> usize {
        match self {
            Factor::Sign | Factor::Velocity => 1,
            Factor::One | Factor::VelocitySquared | Factor::LoadSign => 0,
        }
    }

    /// How the factor reads in an equation.
    pub fn text(self) -> &'static str {
        match self {
            Factor::Sign => "tanh(v/v_eps)",
            Factor::Velocity => "v",
            Factor::One => "1",
            Factor::VelocitySquared => "v^2",
            Factor::LoadSign => "|tau_l| tanh(v/v_eps)",
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
/// Non-centralities that the prior of a series expects of its first coefficient; the others fall with the square of their order.
const PRIOR_STRENGTHS: [f64; 3] = [20.0, 200.0, 2000.0];
/// Precision that one row in ten thousand would give: the price of a named coefficient.
const UNIT_INFORMATION: f64 = 1e-4;
/// Order for position, where a narrow place matters.
const NARROW_ORDER: usize = 20;

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
    if state.load.is_some() {
        add(&[Factor::LoadSign], Channel::Position);
        add(&[Factor::LoadSign], Channel::Temperature);
    }
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
    let rank = rank_transform(&series, &state.memory.at_rest);
    let factor: Vec<f64> = match rival.factor {
        Factor::Sign => state.sign.clone(),
        Factor::Velocity => state.velocity.clone(),
        Factor::One => vec![1.0; state.len()],
        Factor::VelocitySquared => state.velocity.iter().map(|v| v * v).collect(),
        Factor::LoadSign => match &state.load {
            Some(load) => state.map(|i| load[i].abs() * state.sign[i]),
            None => return Vec::new(),
        },
    };
    // cos(j x) by the Chebyshev recurrence.
    let base: Vec<f64> = rank.iter().map(|u| (std::f64::consts::PI * u).cos()).collect();
    let mut columns: Vec<Vec<f64>> = vec![factor.clone(), base.iter().zip(&factor).map(|(c, f)| c * f).collect()];
    for j in 2..=order {
        let next = (0..state.len()).map(|i| 2.0 * base[i] * columns[j - 1][i] - columns[j - 2][i]).collect();
        columns.push(next);
    }
    columns.split_off(rival.factor.first_order())
}

/// Rank of each value among 512 quantiles of what the series takes in motion, interpolated, in [0, 1].
fn rank_transform(series: &[f64], at_rest: &[bool]) -> Vec<f64> {
    const QUANTILES: usize = 512;
    const DRAWN: usize = 16 * QUANTILES;
    let moving: Vec<f64> = series.iter().zip(at_rest).filter(|(_, rest)| !**rest).map(|(value, _)| *value).collect();
    let all = if moving.is_empty() { series } else { &moving };
    let mut sorted: Vec<f64> = all.iter().copied().step_by((all.len() / DRAWN).max(1)).collect();
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
