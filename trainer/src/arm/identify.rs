//! Bodies and friction of all joints identified together: base parameters that the joints share, friction of each that is free to bend with
//! its velocity and may grow with the load that its gear transmits (Swevers et al. 1997; Bittencourt & Gunnarsson 2012). Each joint counts
//! by the noise that is left of it; errors leave out blocks of time.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::SeedableRng;
use statrs::distribution::{ContinuousCDF, StudentsT};

use super::base::Base;
use super::chain::{Chain, INERTIAL};
use super::dynamics::NUMBERS;
use super::motion::{Columns, Motion, torque_of};
use super::system::{Expected, JointRows, System};
use crate::error::{Error, Result, codes};
use crate::numerics::averages::Averages;
use crate::numerics::jackknife::{ERROR_BLOCKS, even_blocks};
use crate::numerics::random::normal;
use crate::numerics::statistics::{NORMAL_95, root_mean_square};
use crate::samples::BendingLaw;
use crate::samples::states::States;

/// Rounds of weights and loads: each is settled to a per cent after two.
const ROUNDS: usize = 3;
/// Chance that load-dependent friction is named on any joint of an arm that has none.
const FALSE_ALARM: f64 = 0.01;
/// A parameter that is known within this share of itself, with 95 %, is determined.
const DETERMINED_WITHIN: f64 = 0.05;
/// Share of a parameter that noise of the motion and its nominal value may have in it; beyond, nothing is known of it.
const MOST_SHARE: f64 = 0.5;
/// Standard deviation of a nominal number of a body, over the size that the mass and reach of the body give it.
const NOMINAL_ERROR: f64 = 1.0;

/// A base parameter as it was found.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// SI.
    pub value: f64,
    /// Standard error.
    pub standard_error: f64,
    /// 95 % interval, with what noise of the motion may have taken; `None` where the motion does not determine the parameter.
    pub ci95: Option<[f64; 2]>,
}

/// Friction per transmitted load, N m per N m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadFriction {
    /// Estimate.
    pub value: f64,
    /// 95 % interval.
    pub ci95: [f64; 2],
}

/// What was found of an arm.
#[derive(Clone, Debug)]
pub struct Identified {
    /// In the order of the base parameters.
    pub parameters: Vec<Estimate>,
    /// Of each joint; `None` where it does not show.
    pub load: Vec<Option<LoadFriction>>,
    /// Inertia of each joint that its gear does not transmit, though it is not told from that of the link: of the rotor, by how friction
    /// grows. Zero where nothing says so.
    pub before_gear: Vec<f64>,
    /// Root mean square of what is left of each joint, unit of its actuator.
    pub left: Vec<f64>,
}

impl Identified {
    /// Values of the base parameters.
    #[must_use]
    pub fn values(&self) -> Vec<f64> {
        self.parameters.iter().map(|estimate| estimate.value).collect()
    }
}

/// Where and how each joint moves, and the noise of it.
pub(super) struct Moving {
    pub(super) states: States,
    /// Standard deviations of the noise of velocity and acceleration.
    pub(super) noise: [f64; 2],
}

/// What is known of the bodies before: the values of the URDF and how far they may be off, by mass and reach of each body.
pub(super) fn expected(chain: &Chain, base: &Base) -> Expected {
    let mut numbers = Vec::with_capacity(NUMBERS * chain.len());
    let mut errors = Vec::with_capacity(numbers.capacity());
    for joint in &chain.joints {
        let [mass, x, y, z, xx, _, yy, _, _, zz] = joint.nominal;
        // Radius of gyration about the joint, or the lever of the mass where it has no extent.
        let reach = if mass > 0.0 {
            (0.5 * (xx + yy + zz) / mass).max((x * x + y * y + z * z) / (mass * mass)).max(0.0).sqrt()
        } else {
            0.0
        };
        numbers.extend(joint.nominal.iter().copied().chain([0.0]));
        // Of rotors a URDF says nothing.
        let size = [0, 1, 1, 1, 2, 2, 2, 2, 2, 2].map(|order| NOMINAL_ERROR * mass * reach.powi(order));
        errors.extend(size.into_iter().chain([f64::INFINITY]));
    }
    let variance = base
        .combined(|place, factor| (factor * if errors[place] > 0.0 { errors[place] } else { f64::INFINITY }).powi(2));
    let precision = variance.into_iter().map(|variance| variance.recip()).collect();
    Expected { values: base.values(&numbers), precision }
}

/// Identifies bodies and friction.
///
/// # Errors
/// `FRK-D016` when a joint that moves has one speed only, `FRK-N001` when nothing can be told apart.
pub(super) fn identify(
    chain: &Chain,
    base: &Base,
    motion: &Motion,
    columns: &Columns,
    moving: &[Moving],
) -> Result<Identified> {
    let joints = chain.len();
    let expected = expected(chain, base);
    let bending = moving.iter().map(|moving| bending(&moving.states)).collect::<Result<Vec<_>>>()?;
    let mut load: Vec<Vec<Vec<f64>>> = vec![Vec::new(); joints];
    let mut before_gear = vec![0.0; joints];
    let mut found = solve(base, motion, columns, (&expected, moving), &bending, &load)?;
    let threshold = least_t(joints);
    let mut open: Vec<bool> = moving.iter().map(|moving| !moving.states.rows.is_empty()).collect();
    // First with the load of every joint, then with those that show.
    for pass in 0..2 {
        for _ in 0..ROUNDS {
            let values = found.identified.values();
            for joint in (0..joints).filter(|joint| open[*joint]) {
                let acceleration = motion.joints[joint].acceleration.as_deref().unwrap_or_default();
                let carried = transmitted(base, &columns[joint], &values, joint);
                let carried = less(carried, before_gear[joint], acceleration);
                let with_rotor = (pass == 1 && !base.tells_rotor(joint)).then_some(acceleration);
                load[joint] = load_columns(&carried, with_rotor, &moving[joint].states);
            }
            found = solve(base, motion, columns, (&expected, moving), &bending, &load)?;
            for (joint, more) in found.before_gear.iter().enumerate() {
                // No more than the whole inertia, and none below zero.
                let whole = whole_inertia(base, &found.identified.values(), joint);
                before_gear[joint] = (before_gear[joint] + more).clamp(0.0, whole);
            }
        }
        if pass == 0 {
            let shows = |joint: usize| found.loads[joint].is_some_and(|(value, error)| value > threshold * error);
            open = (0..joints).map(shows).collect();
            (0..joints).filter(|joint| !open[*joint]).for_each(|joint| load[joint].clear());
        }
    }
    let mut identified = found.identified;
    let interval = |(value, error): (f64, f64)| {
        let half = NORMAL_95 * error;
        LoadFriction { value, ci95: [value - half, value + half] }
    };
    identified.before_gear = before_gear;
    identified.load = found.loads.into_iter().map(|load| load.map(interval)).collect();
    let shares = shares(chain, base, (motion, columns, moving), &found.system, &found.weights, &expected);
    for (estimate, share) in identified.parameters.iter_mut().zip(shares) {
        estimate.ci95 = determined(estimate, share);
    }
    Ok(identified)
}

/// Load that a joint's gear transmits: the bodies beyond it, without the rotor before it.
pub(super) fn transmitted(base: &Base, columns: &[Option<Vec<f64>>], values: &[f64], joint: usize) -> Vec<f64> {
    torque_of(columns, values, |index| base.parameters[index].rotor() != Some(joint))
}

/// What is left of a torque without an inertia.
pub(super) fn less(mut torque: Vec<f64>, inertia: f64, acceleration: &[f64]) -> Vec<f64> {
    torque.iter_mut().zip(acceleration).for_each(|(torque, a)| *torque -= inertia * a);
    torque
}

/// The inertia of a joint from which its rotor is not told; 0 where it is.
fn whole_inertia(base: &Base, values: &[f64], joint: usize) -> f64 {
    let place = joint * NUMBERS + INERTIAL;
    let holding = base.parameters.iter().zip(values).map(|(parameter, value)| {
        let factor = parameter.terms.iter().find(|(of, _)| *of == place).map(|(_, factor)| *factor);
        factor.map(|factor| (value / factor).max(0.0))
    });
    holding.flatten().fold(0.0, f64::max)
}

/// Smallest t statistic at which load-dependent friction shows.
fn least_t(joints: usize) -> f64 {
    let freedom = (ERROR_BLOCKS - 1) as f64;
    StudentsT::new(0.0, 1.0, freedom)
        .map_or(f64::INFINITY, |student| student.inverse_cdf(1.0 - FALSE_ALARM / joints.max(1) as f64))
}

struct Solved {
    identified: Identified,
    /// Friction per load of each joint with its standard error.
    loads: Vec<Option<(f64, f64)>>,
    /// Inertia of each joint that its load has too much of.
    before_gear: Vec<f64>,
    system: System,
    weights: Vec<f64>,
}

fn solve(
    base: &Base,
    motion: &Motion,
    columns: &Columns,
    (expected, moving): (&Expected, &[Moving]),
    bending: &[Vec<Vec<f64>>],
    load: &[Vec<Vec<f64>>],
) -> Result<Solved> {
    let target: Vec<&[f64]> =
        motion.joints.iter().map(|samples| samples.actuator.as_deref().unwrap_or_default()).collect();
    let rows = (0..moving.len()).map(|joint| JointRows {
        rows: &moving[joint].states.rows,
        shared: &columns[joint],
        own: load[joint].iter().chain(&bending[joint]).cloned().collect(),
        target: target[joint],
        scored: target[joint],
    });
    let system = System::new(&rows.collect::<Vec<_>>(), &even_blocks(motion.len(), ERROR_BLOCKS));
    let mut weights: Vec<f64> = target.iter().map(|torque| weight(root_mean_square(torque).powi(2))).collect();
    let mut solution = None;
    for _ in 0..ROUNDS {
        let all = &|_| true;
        let solved = system.solve(&weights, expected, all).ok_or_else(nothing_told_apart)?;
        weights = system.left(&solved, all, false).into_iter().map(weight).collect();
        solution = Some(solved);
    }
    let solution = solution.ok_or_else(nothing_told_apart)?;
    let errors = system.errors(&weights, expected);
    let error_of = |index: usize| errors.iter().map(|error| error[index].powi(2)).sum::<f64>().sqrt();
    let parameter = |index: usize| Estimate { value: solution[index], standard_error: error_of(index), ci95: None };
    let of_load = |joint: usize| {
        let place = system.first_of(joint);
        (!load[joint].is_empty()).then(|| (solution[place], error_of(place)))
    };
    let before_gear = |joint: usize| {
        let place = system.first_of(joint);
        if load[joint].len() > 1 && solution[place] > 0.0 { solution[place + 1] / solution[place] } else { 0.0 }
    };
    let before_gear = (0..load.len()).map(before_gear).collect();
    let loads = (0..load.len()).map(of_load).collect();
    let left = system.left(&solution, &|_| true, false).into_iter().map(f64::sqrt).collect();
    let parameters = (0..base.len()).map(parameter).collect();
    Ok(Solved {
        identified: Identified { parameters, load: Vec::new(), before_gear: Vec::new(), left },
        loads,
        before_gear,
        system,
        weights,
    })
}

fn nothing_told_apart() -> Error {
    Error::new(&codes::NOT_IDENTIFIABLE, "bodies and friction of the joints cannot be told apart on this motion")
}

/// One over a mean square; nothing where there is none.
fn weight(mean_square: f64) -> f64 {
    if mean_square > 0.0 { mean_square.recip() } else { 0.0 }
}

/// Friction over velocity, free to bend; nothing of a joint that does not move.
fn bending(states: &States) -> Result<Vec<Vec<f64>>> {
    if states.rows.is_empty() {
        return Ok(Vec::new());
    }
    Ok(BendingLaw::over(&states.velocity)?.averaged_columns(&states.velocity, &states.averages))
}

/// Sign of the velocity times size of the load; and what the latter loses for each unit of an inertia that the load has too much of.
fn load_columns(load: &[f64], acceleration: Option<&[f64]>, states: &States) -> Vec<Vec<f64>> {
    let signs = averaged_sign(&states.averages, &states.velocity);
    let of = |value: &dyn Fn(usize) -> f64| -> Vec<f64> {
        states.rows.iter().zip(&signs).map(|(row, sign)| sign * value(*row)).collect()
    };
    let size = of(&|row| load[row].abs());
    let lost = acceleration.map(|acceleration| of(&|row| -load[row].signum() * acceleration[row]));
    std::iter::once(size).chain(lost).collect()
}

fn averaged_sign(averages: &Averages, velocity: &[f64]) -> Vec<f64> {
    averages.over(&velocity.iter().map(|v| v.signum()).collect::<Vec<f64>>())
}

/// Share of each base parameter that noise of the motion takes (errors in variables; Fuller 1987), and that its nominal value has.
fn shares(
    chain: &Chain,
    base: &Base,
    (motion, columns, moving): (&Motion, &Columns, &[Moving]),
    system: &System,
    weights: &[f64],
    expected: &Expected,
) -> Vec<f64> {
    let mut random = ChaCha8Rng::seed_from_u64(1);
    let rows = motion.len();
    let noise: Vec<Vec<[f64; 2]>> = moving
        .iter()
        .map(|moving| (0..rows).map(|_| moving.noise.map(|deviation| deviation * normal(&mut random))).collect())
        .collect();
    let moved = motion.columns_moved(chain, base, |row, joint| noise[joint][row]);
    let mut energy = vec![0.0; base.len()];
    for (joint, weight) in weights.iter().enumerate() {
        for (energy, pair) in energy.iter_mut().zip(columns[joint].iter().zip(&moved[joint])) {
            let (Some(column), Some(moved)) = pair else { continue };
            let change = |row: &usize| (moved[*row] - column[*row]).powi(2);
            *energy += weight * moving[joint].states.rows.iter().map(change).sum::<f64>();
        }
    }
    let told = system.told(weights);
    let share = |index: usize| {
        let beside = energy[index] + expected.precision[index];
        if told[index] > 0.0 { beside / told[index] } else { f64::INFINITY }
    };
    (0..base.len()).map(share).collect()
}

/// The interval of a parameter that is known within a small share of itself.
fn determined(estimate: &Estimate, share: f64) -> Option<[f64; 2]> {
    if share >= MOST_SHARE {
        return None;
    }
    let value = estimate.value;
    let whole = value / (1.0 - share);
    let half = NORMAL_95 * estimate.standard_error;
    let interval = [value.min(whole) - half, value.max(whole) + half];
    let furthest = (value - interval[0]).max(interval[1] - value);
    (furthest <= DETERMINED_WITHIN * value.abs()).then_some(interval)
}
