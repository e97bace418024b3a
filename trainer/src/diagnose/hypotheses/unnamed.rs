//! Structures without a name: a factor of velocity times a function of a channel.

use crate::diagnose::hypotheses::channel::Channel;
use crate::diagnose::hypotheses::function_form::{Form, Function};
use crate::physics::{JointState, Shape};
use std::ops::Range;

/// A generic rival: `factor(v) * c(channel)`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Generic {
    /// Factor of velocity.
    pub factor: Factor,
    /// Channel on which it depends.
    pub channel: Channel,
    /// What is known of the function of the channel.
    pub form: Form,
}

impl Generic {
    /// Its shapes, each with the place of its columns in [`Self::pool`]. Of a free function: order of the cosine series and
    /// strength of the prior (0 for none); of a form, see there.
    pub(crate) fn variants(self, state: &JointState) -> Vec<(Shape, Range<usize>)> {
        if self.form == Form::Free {
            let width = |order: f64| order as usize + 1 - self.factor.first_order();
            return self.free_shapes().into_iter().map(|shape| (shape.clone(), 0..width(shape[0]))).collect();
        }
        let mut end = 0;
        let place = |shape: Shape| {
            let begin = end;
            end += self.form.functions(&shape).len() + usize::from(self.has_constant());
            (shape, begin..end)
        };
        self.grid(state).into_iter().map(place).collect()
    }

    /// The columns of all its shapes, at the recording's rate.
    pub(crate) fn pool(self, state: &JointState) -> Vec<Vec<f64>> {
        match self.form {
            Form::Free => self.columns(state, &[self.longest() as f64, 0.0]),
            _ => self.grid(state).iter().flat_map(|shape| self.columns(state, shape)).collect(),
        }
    }

    /// The columns of one shape, at the recording's rate; none where the recording lacks a channel.
    pub(crate) fn columns(self, state: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        self.columns_ranked(state, state, shape)
    }

    /// The same with the ranks that the channel's values have among those of another recording.
    pub(crate) fn columns_ranked(self, state: &JointState, among: &JointState, shape: &[f64]) -> Vec<Vec<f64>> {
        let Some(ranked) = self.channel.series(among) else { return Vec::new() };
        let Some((series, factor)) = self.channel.series(state).zip(self.factor.series(state)) else {
            return Vec::new();
        };
        if self.form == Form::Free {
            let knots = rank_knots(&ranked, &among.memory.at_rest);
            let mut columns = cosines(&series, &knots, &factor, shape[0] as usize);
            return columns.split_off(self.factor.first_order());
        }
        let column = |function: Function| series.iter().zip(&factor).map(|(x, f)| f * function(*x)).collect();
        let mut columns: Vec<Vec<f64>> = self.form.functions(shape).into_iter().map(column).collect();
        if self.has_constant() {
            columns.push(factor);
        }
        columns
    }

    /// Shapes of its form over the range of the channel.
    pub(crate) fn grid(self, state: &JointState) -> Vec<Shape> {
        let widths = if self.channel == Channel::Position { POSITION_BUMP_PARTS } else { BUMP_PARTS };
        self.range(state).map(|range| self.form.grid(range, widths)).unwrap_or_default()
    }

    /// Range of the channel, where the recording has it and it moves.
    pub(crate) fn range(self, state: &JointState) -> Option<(f64, f64)> {
        let series = self.channel.series(state)?;
        let wider = |(low, high): (f64, f64), value: &f64| (low.min(*value), high.max(*value));
        Some(series.iter().fold((f64::INFINITY, f64::NEG_INFINITY), wider)).filter(|(low, high)| high > low)
    }

    /// How the functions read that its coefficients of one shape belong to; nothing stands for a constant.
    pub(crate) fn texts(self, shape: &[f64]) -> Vec<String> {
        let constant = self.has_constant().then(String::new);
        self.form.texts(shape, self.channel.name()).into_iter().chain(constant).collect()
    }

    /// Whether a constant belongs to its form: where the base does not hold the factor, and it is no bump upon nothing.
    fn has_constant(self) -> bool {
        self.factor.first_order() == 0 && matches!(self.form, Form::Series | Form::Quadratic | Form::Wave | Form::Step)
    }

    /// Prior precision of each coefficient over what all rows tell of it: that of a smooth function for a series with a prior,
    /// none for anything else.
    pub(crate) fn ridge(self, shape: &[f64]) -> Vec<f64> {
        if self.form != Form::Free || shape[1] == 0.0 {
            return Vec::new();
        }
        let orders = self.factor.first_order()..=shape[0] as usize;
        orders.map(|j| if j == 0 { UNIT_INFORMATION } else { (j * j) as f64 / shape[1] }).collect()
    }

    /// Orders and strengths of the prior of a free function.
    fn free_shapes(self) -> Vec<Shape> {
        let longest = self.longest();
        let free = [GENERIC_ORDERS[0], longest].map(|order| vec![order as f64, 0.0]);
        let smooth = PRIOR_STRENGTHS.map(|strength| vec![longest as f64, strength]);
        free.into_iter().chain(smooth).filter(|shape| !self.has_a_name(shape)).collect()
    }

    /// Largest order of its series.
    fn longest(self) -> usize {
        match (self.factor, self.channel) {
            (Factor::Sign, Channel::Position) => POSITION_SERIES_ORDER,
            _ => GENERIC_ORDERS[1],
        }
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

    /// The factor at the recording's rate, where the recording has it.
    fn series(self, state: &JointState) -> Option<Vec<f64>> {
        match self {
            Factor::Sign => Some(state.sign.clone()),
            Factor::Velocity => Some(state.velocity.clone()),
            Factor::One => Some(vec![1.0; state.len()]),
            Factor::VelocitySquared => Some(state.velocity.iter().map(|v| v * v).collect()),
            Factor::LoadSign => state.load.as_ref().map(|load| state.map(|i| load[i].abs() * state.sign[i])),
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

/// Orders of the cosine series of an unnamed structure: a broad and a detailed function. Chosen by judgement: in a
/// study on simulated joints separate series of these orders named the right channel in 16 of 16 unknown structures,
/// one joint block of polynomials in 1.
const GENERIC_ORDERS: [usize; 2] = [3, 12];
/// Non-centralities (dimensionless) that the prior of a series expects of its first coefficient; the others fall with
/// the square of their order. In decades: the evidence chooses among them.
const PRIOR_STRENGTHS: [f64; 3] = [20.0, 200.0, 2000.0];
/// Prior precision over that of all rows: one row in ten thousand, the usual number of rows, as in the Bayesian
/// criterion (unit information, Kass and Wasserman 1995).
const UNIT_INFORMATION: f64 = 1e-4;
/// Order of the series over position: a feature of a twentieth of the range, such as a worn place. Chosen by judgement:
/// lower blurs it, higher pays for coefficients that noise fills.
const POSITION_SERIES_ORDER: usize = 20;
/// Parts of the range of position that a bump takes on the grid: a damaged tooth is narrow. Refined afterwards.
const POSITION_BUMP_PARTS: [usize; 2] = [32, 64];
/// The same of the other channels, over which no effect is known to be narrow.
const BUMP_PARTS: [usize; 2] = [8, 16];

/// The generic rivals that the channels allow.
pub(crate) fn generic_rivals(state: &JointState) -> Vec<Generic> {
    let mut rivals = Vec::new();
    let mut add = |factors: &[Factor], channel: Channel, form: Form| {
        let of_factor = |&factor| Generic { factor, channel, form };
        rivals.extend(factors.iter().map(of_factor).filter(|rival| rival.range(state).is_some()));
    };
    let all = [Factor::Sign, Factor::Velocity, Factor::One];
    for channel in [Channel::Position, Channel::Load, Channel::Temperature, Channel::Time, Channel::Acceleration] {
        add(&all, channel, Form::Free);
    }
    add(&[Factor::VelocitySquared], Channel::Position, Form::Free);
    add(&[Factor::Velocity], Channel::Position, Form::Series);
    if state.load.is_some() {
        add(&[Factor::LoadSign], Channel::Position, Form::Free);
        add(&[Factor::LoadSign], Channel::Position, Form::Series);
        add(&[Factor::LoadSign], Channel::Temperature, Form::Free);
    }
    add(&[Factor::Sign, Factor::One], Channel::Speed, Form::Free);
    add(&[Factor::Sign], Channel::DistanceSinceReversal, Form::Free);
    add(&[Factor::Sign], Channel::TimeSinceReversal, Form::Free);
    for joint in 0..state.other_joints.len() {
        add(&all, Channel::OtherVelocity(joint), Form::Free);
        add(&all, Channel::OtherPosition(joint), Form::Free);
    }
    add(&[Factor::Sign, Factor::Velocity], Channel::Load, Form::Quadratic);
    for channel in [Channel::Position, Channel::Speed, Channel::Temperature] {
        add(&[Factor::Sign], channel, Form::Place);
    }
    rivals
}

/// Cosine series of the rank-transformed channel times the factor, up to an order.
fn cosines(series: &[f64], knots: &[f64], factor: &[f64], order: usize) -> Vec<Vec<f64>> {
    let rank = rank_transform(series, knots);
    // cos(j x) by the Chebyshev recurrence.
    let base: Vec<f64> = rank.iter().map(|u| (std::f64::consts::PI * u).cos()).collect();
    let mut columns = vec![factor.to_vec(), base.iter().zip(factor).map(|(c, f)| c * f).collect()];
    for j in 2..=order {
        let next = (0..series.len()).map(|i| 2.0 * base[i] * columns[j - 1][i] - columns[j - 2][i]).collect();
        columns.push(next);
    }
    columns
}

/// Quantiles between which ranks are interpolated: finer than the shortest wave of [`POSITION_SERIES_ORDER`] by a factor of fifty.
const QUANTILES: usize = 512;
/// Samples from which the quantiles are taken, sixteen a quantile. A limit of the computing time.
const RANKED_SAMPLES: usize = 16 * QUANTILES;

/// Quantiles of what a series takes in motion.
fn rank_knots(series: &[f64], at_rest: &[bool]) -> Vec<f64> {
    let moving: Vec<f64> = series.iter().zip(at_rest).filter(|(_, rest)| !**rest).map(|(value, _)| *value).collect();
    let all = if moving.is_empty() { series } else { &moving };
    let mut sorted: Vec<f64> = all.iter().copied().step_by((all.len() / RANKED_SAMPLES).max(1)).collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let last = sorted.len() - 1;
    (0..=QUANTILES).map(|k| sorted[last * k / QUANTILES]).collect()
}

/// Rank of each value among quantiles, interpolated, in [0, 1].
fn rank_transform(series: &[f64], knots: &[f64]) -> Vec<f64> {
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
