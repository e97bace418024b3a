//! Moves a joint through a recording.

use super::body::Body;
use super::resistance::{Instant, Resistance};
use super::series::Series;
use crate::actuator::{Actuator, Kind, Motion};
use crate::error::{Error, Result, codes};
use crate::numerics::Number;
use crate::numerics::dry_friction::{Motion1D, advance};
use crate::recording::{GAP_PERIODS, Quantity, Recording};

/// Longest step of the integration, s: well below the period of a position loop's oscillation. Dry friction, drag and back-EMF are solved
/// exactly within a step, so that only stiffness limits it.
const LONGEST_STEP_S: f64 = 1e-3;

/// Beyond this speed the simulation is taken to have diverged, rad/s or m/s.
const RUNAWAY: f64 = 1e4;

/// Half the time over which the velocity of a start is read off the position, s.
const START_HALF_S: f64 = 0.01;

/// Where a joint is, and how fast it moves.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State<T = f64> {
    /// rad or m
    pub position: T,
    /// rad/s or m/s
    pub velocity: T,
}

/// A joint with its actuator.
#[derive(Clone, Copy, Debug)]
pub struct Rig<T = f64> {
    /// What drives it.
    pub actuator: Actuator<T>,
    /// What is driven.
    pub body: Body<T>,
}

/// The recorded states of a recording.
#[derive(Clone, Copy)]
pub(super) struct Recorded<'r> {
    time: &'r [f64],
    position: &'r [f64],
    velocity: Option<&'r [f64]>,
    /// Of an excerpt the longest step within a stretch, s: what lies beyond is of another one.
    longest_step_s: f64,
}

impl<'r> Recorded<'r> {
    /// # Errors
    /// `FRK-D009` without clock or position.
    pub(super) fn of(recording: &'r Recording) -> Result<Self> {
        Ok(Self {
            time: &recording.require(&[Quantity::Time], "a forward simulation")?.values,
            position: &recording.require(&[Quantity::Position], "a forward simulation")?.values,
            velocity: recording.values(Quantity::Velocity),
            longest_step_s: if recording.is_excerpt { longest_step_s(recording) } else { f64::INFINITY },
        })
    }

    /// The state at a row.
    pub(super) fn at(&self, row: usize) -> State {
        let velocity = self.velocity.map_or_else(|| self.slope(row), |velocity| velocity[row]);
        State { position: self.position[row], velocity }
    }

    /// Slope of the line through the positions around a row.
    fn slope(&self, row: usize) -> f64 {
        let Self { time, position, longest_step_s, .. } = *self;
        let near = |other: &usize| {
            let apart_s = (time[*other] - time[row]).abs();
            apart_s <= START_HALF_S || other.abs_diff(row) <= 1 && apart_s <= longest_step_s
        };
        let first = (0..row).rev().take_while(near).last().unwrap_or(row);
        let last = (row + 1..time.len()).take_while(near).last().unwrap_or(row);
        let count = (last - first + 1) as f64;
        let mean = |values: &[f64]| values[first..=last].iter().sum::<f64>() / count;
        let (middle, level) = (mean(time), mean(position));
        let (mut product, mut square) = (0.0, 0.0);
        for other in first..=last {
            product += (time[other] - middle) * (position[other] - level);
            square += (time[other] - middle).powi(2);
        }
        if square > 0.0 { product / square } else { 0.0 }
    }
}

/// Rows of a recording from which its recorded state is taken anew, with that state: the first, those after a gap, and one every
/// `window_s` where that is given.
///
/// # Errors
/// `FRK-D009` without clock or position.
pub fn starts(recording: &Recording, window_s: Option<f64>) -> Result<Vec<(usize, State)>> {
    let recorded = Recorded::of(recording)?;
    let time = recorded.time;
    let gap = longest_step_s(recording);
    let interruptions = &recording.health.interruptions;
    let mut rows: Vec<usize> = Vec::new();
    for row in 0..time.len() {
        let is_due = rows.last().is_none_or(|last| window_s.is_some_and(|window| time[row] - time[*last] >= window));
        let interrupted = row > 0 && time[row] - time[row - 1] > gap || interruptions.binary_search(&row).is_ok();
        if is_due || interrupted {
            rows.push(row);
        }
    }
    Ok(rows.into_iter().map(|row| (row, recorded.at(row))).collect())
}

/// Longest step of the clock that is no gap, s.
fn longest_step_s(recording: &Recording) -> f64 {
    recording.health.period_s.map_or(f64::INFINITY, |period| GAP_PERIODS * period)
}

/// The recorded state at every row.
///
/// # Errors
/// As [`starts`].
pub fn recorded(recording: &Recording) -> Result<Vec<State>> {
    let recorded = Recorded::of(recording)?;
    Ok((0..recording.len()).map(|row| recorded.at(row)).collect())
}

/// The motion at every row from the first of `starts` on, begun anew at each of them (row and state in order). In dual numbers it is the motion
/// with its derivative by the parameter whose derivative is one.
///
/// # Errors
/// `FRK-N004` where the motion leaves all bounds, or a late feedback takes all of the inertia.
pub fn simulate<T: Number>(
    rig: &Rig<T>,
    series: &Series,
    resistance: &mut impl Resistance<T>,
    starts: &[(usize, State)],
) -> Result<Vec<State<T>>> {
    let late = rig.actuator.kd * rig.actuator.feedback_delay_s;
    if rig.actuator.kind == Kind::Pd && rig.body.inertia <= late {
        let message = "a controller that sees the motion so late takes all of the inertia: kd times feedback_delay_s";
        return Err(Error::new(&codes::DIVERGED, message).in_column("actuator.feedback_delay_s"));
    }
    let mut states = Vec::with_capacity(series.time.len());
    let first = starts.first().map_or(series.time.len(), |(row, _)| *row);
    let mut starts = starts.iter().peekable();
    let mut moving = Motion1D { position: T::zero(), velocity: T::zero() };
    for row in first..series.time.len() {
        if let Some((_, state)) = starts.next_if(|(start, _)| *start == row) {
            moving = Motion1D { position: state.position.into(), velocity: state.velocity.into() };
            resistance.restart();
        } else {
            pass(rig, series, resistance, row - 1, &mut moving);
        }
        let speed = moving.velocity.re().abs();
        if speed.is_nan() || speed > RUNAWAY {
            let message = "the simulated joint runs away: gains, inertia or friction cannot be those of this joint";
            return Err(Error::new(&codes::DIVERGED, message).at_row(row as u64 + 1));
        }
        states.push(State { position: moving.position, velocity: moving.velocity });
    }
    Ok(states)
}

/// From one row to the next.
fn pass<T: Number>(
    rig: &Rig<T>,
    series: &Series,
    resistance: &mut impl Resistance<T>,
    row: usize,
    moving: &mut Motion1D<T>,
) {
    let begin = series.time[row];
    let span = series.time[row + 1] - begin;
    let steps = (span / LONGEST_STEP_S - 1e-6).ceil().max(1.0);
    let step_s = span / steps;
    let temperature = series.temperature.get(row).copied().unwrap_or(f64::NAN);
    for step in 0..steps as usize {
        let time = begin + (step as f64 + 0.5) * step_s;
        let command = series.at(-rig.actuator.delay_s + time, row);
        // Position in the middle of the step, to which stiffness and gravity are taken: of second order.
        let position = moving.position + moving.velocity * (0.5 * step_s);
        let applied = rig.actuator.apply(&command, Motion { position, velocity: moving.velocity });
        let gravity = rig.body.gravity(position);
        // What the gear carries: the torque of the motor where that is known, else what gravity asks of it.
        let load = if rig.actuator.kind == Kind::Torque { gravity } else { applied.at(moving.velocity) };
        let at = Instant { time, position, velocity: moving.velocity, load, temperature };
        let levels = resistance.levels(&at, step_s);
        let push = applied.torque - gravity - rig.body.offset;
        advance(moving, push, levels.dry, levels.viscous + applied.damping, rig.body.inertia + applied.inertia, step_s);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actuator::Command;
    use crate::numerics::dry_friction::DryLevels;
    use crate::rollout::Levels;
    use num_dual::Dual64;

    /// Coulomb friction of 0.5 N m.
    struct Coulomb;

    impl<T: Number> Resistance<T> for Coulomb {
        fn levels(&mut self, _: &Instant<T>, _: f64) -> Levels<T> {
            let level = T::from(0.5);
            Levels { dry: DryLevels { forward: level, backward: level }, viscous: T::zero() }
        }
    }

    fn under(torque: f64, body: Body, rows: usize) -> Vec<State> {
        let series = Series::held(Command { effort: torque, enabled: true, ..Command::default() }, 0.01, rows);
        let rig = Rig { actuator: Actuator::ideal(Kind::Torque), body };
        simulate(&rig, &series, &mut Coulomb, &[(0, State { position: 0.2, velocity: 0.0 })]).unwrap()
    }

    #[test]
    fn a_joint_sticks_below_break_away_and_is_exact_above() {
        let body = Body { inertia: 0.1, ..Body::default() };
        assert!(under(0.499, body, 100).iter().all(|state| *state == State { position: 0.2, velocity: 0.0 }));
        let free = under(0.7, body, 101)[100];
        assert!((free.velocity - 2.0).abs() < 1e-9 && (free.position - 1.2).abs() < 1e-9, "{free:?}");
    }

    /// The gain and the delay of a controller under a ramp of its reference, and the inertia that it moves.
    #[test]
    fn dual_numbers_carry_the_derivative_of_the_motion() {
        let rows = 100;
        let mut series = Series::held(Command { enabled: true, ..Command::default() }, 0.01, rows);
        for (row, command) in series.commands.iter_mut().enumerate() {
            command.reference = 0.2 + 0.4 * (0.08 * row as f64).sin();
        }
        let end = |[kp, delay, inertia]: [Dual64; 3]| {
            let pd = Actuator { kd: 0.5, feedback_delay_s: 0.001, ..Actuator::ideal(Kind::Pd) };
            let actuator = Actuator { kp, delay_s: delay, ..pd.lifted() };
            let [zero, gravity] = [0.0, 2.0].map(Dual64::from);
            let body = Body { inertia, gravity_sin: gravity, gravity_cos: zero, offset: zero };
            let starts = [(0, State { position: 0.2, velocity: 0.0 })];
            simulate(&Rig { actuator, body }, &series, &mut Coulomb, &starts).unwrap()[rows - 1].position
        };
        let at = [20.0, 0.0137, 0.1];
        for moved in 0..at.len() {
            let with = |value: f64, slope: f64| {
                let mut constants = at.map(Dual64::from);
                constants[moved] = Dual64::new(value, slope);
                end(constants)
            };
            let step = 1e-5 * at[moved];
            let slope = (with(at[moved] + step, 0.0).re - with(at[moved] - step, 0.0).re) / (2.0 * step);
            let carried = with(at[moved], 1.0).eps;
            assert!((carried - slope).abs() < 1e-4 * slope.abs(), "{moved}: {carried} {slope}");
        }
    }

    #[test]
    fn a_pendulum_keeps_its_energy_but_for_friction() {
        let body = Body { inertia: 0.1, gravity_sin: 20.0, ..Body::default() };
        let states = under(0.0, body, 400);
        let energy = |state: &State| 0.05 * state.velocity.powi(2) + 20.0 * (1.0 - state.position.cos());
        let mut way = 0.0;
        for pair in states.windows(2).take(30) {
            way += (pair[1].position - pair[0].position).abs();
        }
        let lost = energy(&states[0]) - energy(&states[30]);
        assert!((lost - 0.5 * way).abs() < 0.02 * lost, "{lost} {way}");
        let last = states[399];
        assert!(last.velocity == 0.0 && (20.0 * last.position.sin()).abs() <= 0.5);
    }
}
