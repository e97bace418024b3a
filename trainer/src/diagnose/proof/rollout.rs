//! The open-loop rollout: the recorded torque drives the model from a recorded state; how far does its position stray?
//!
//! It is worked out as a deviation from the recorded motion: `J dv/dt = r - (f(v_rec + v) - f(v_rec))`, `dq/dt = v`, where
//! `r` is the torque that the model leaves at the recorded state. `f` is the friction of the base over velocity as it was before
//! any effect, for both models, and `J` that of a given rigid body where there is one: what the findings change of either is felt
//! through `r` alone. Memories and gravity are taken at the recorded motion too, which holds over short horizons.

use crate::diagnose::evidence::workbench::Workbench;
use crate::diagnose::proof::locked_rows::rest;
use crate::diagnose::proof::refit::Refit;
use crate::physics::{JointState, nominal_inertia};
use serde::Serialize;
use std::ops::Range;

/// Position error of open-loop rollouts before and after, in rad or m.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Rollout {
    /// Length of one rollout, s.
    pub horizon_s: f64,
    /// Number of rollouts.
    pub starts: usize,
    /// Root mean square position error of the base model.
    pub baseline_rmse: f64,
    /// The same with the effects.
    pub improved_rmse: f64,
    /// Mean absolute position error of the base model.
    pub baseline_mae: f64,
    /// The same with the effects.
    pub improved_mae: f64,
    /// Largest position error of the base model.
    pub baseline_max: f64,
    /// The same with the effects.
    pub improved_max: f64,
    /// The motion of every rollout.
    #[serde(skip)]
    pub motions: Vec<Motion>,
}

/// The motion of one rollout, a value for each row.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Time, s.
    pub time: Vec<f64>,
    /// Recorded position, rad or m.
    pub recorded: Vec<f64>,
    /// Position of the base model under the recorded torque.
    pub before: Vec<f64>,
    /// The same with the effects.
    pub after: Vec<f64>,
}

/// Length of one rollout, s: by definition of the reported figure.
const HORIZON_S: f64 = 0.5;
/// Linearly implicit Euler steps between two working rows. Chosen by judgement: the slope of friction is taken anew in
/// each; fewer err where friction turns over, more cost computing time.
const EULER_STEPS: usize = 4;
/// Step of velocity of the difference that gives the slope of friction, over the width of the smoothed sign, within
/// which friction is straight.
const SLOPE_STEP_SHARE: f64 = 0.1;

/// Rolls base and improved model out over the locked rows, or over all where none are locked. `None` without an inertia
/// or a stretch of motion that is long enough.
pub(crate) fn roll_out(workbench: &Workbench, baseline: &Refit, improved: &Refit) -> Option<Rollout> {
    let prepared = workbench.prepared;
    let locked = prepared.locked_runs();
    let runs = if locked.is_empty() { prepared.open_runs() } else { locked };
    let state = &prepared.state;
    let inertia = |refit: &Refit| inertia(state, &workbench.base.names, refit).filter(|inertia| *inertia > 0.0);
    let stretches = stretches(state, &prepared.rows, &runs);
    let strayed = |refit: &Refit| {
        let (residual, inertia) = (rest(workbench, refit), inertia(refit)?);
        let one = |stretch: &Range<usize>| {
            strays(state, &prepared.rows[stretch.clone()], &residual[stretch.clone()], inertia)
        };
        Some(stretches.iter().map(one).collect::<Vec<Vec<f64>>>())
    };
    let (before, after) = (strayed(baseline)?, strayed(improved)?);
    let motions = stretches.iter().zip(before.iter().zip(&after)).map(|(stretch, (before, after))| {
        let rows = &prepared.rows[stretch.clone()];
        let recorded: Vec<f64> = rows.iter().map(|&row| state.position[row]).collect();
        let strayed = |strays: &Vec<f64>| recorded.iter().zip(strays).map(|(q, stray)| q + stray).collect();
        let time = rows.iter().map(|&row| state.time[row]).collect();
        Motion { time, before: strayed(before), after: strayed(after), recorded }
    });
    (!before.is_empty()).then(|| Rollout {
        horizon_s: HORIZON_S,
        starts: before.len(),
        baseline_rmse: root_mean_square_of(&before),
        improved_rmse: root_mean_square_of(&after),
        baseline_mae: mean_of(&before, f64::abs),
        improved_mae: mean_of(&after, f64::abs),
        baseline_max: largest_of(&before),
        improved_max: largest_of(&after),
        motions: motions.collect(),
    })
}

/// Mean over all rollouts of the mean of something in each, their first rows left out, where nothing has strayed yet.
fn mean_of(strays: &[Vec<f64>], of: impl Fn(f64) -> f64) -> f64 {
    let of_one = |strays: &Vec<f64>| strays.iter().map(|stray| of(*stray)).sum::<f64>() / (strays.len() - 1) as f64;
    strays.iter().map(of_one).sum::<f64>() / strays.len() as f64
}

fn root_mean_square_of(strays: &[Vec<f64>]) -> f64 {
    mean_of(strays, |stray| stray * stray).sqrt()
}

fn largest_of(strays: &[Vec<f64>]) -> f64 {
    strays.iter().flatten().fold(0.0, |most, stray| most.max(stray.abs()))
}

/// Inertia in the actuator's unit a unit of acceleration: that of the given rigid body, else that of the base.
fn inertia(state: &JointState, names: &[&str], refit: &Refit) -> Option<f64> {
    match &state.rigid_body {
        Some(_) => nominal_inertia(state),
        None => names.iter().position(|name| *name == "inertia").and_then(|place| refit.base.get(place)).copied(),
    }
}

/// The stretches of rows of a rollout each, within the runs.
fn stretches(state: &JointState, rows: &[usize], runs: &[Range<usize>]) -> Vec<Range<usize>> {
    let mut stretches = Vec::new();
    for run in runs {
        let mut begin = run.start;
        while let Some(end) = (begin..run.end).find(|&k| state.time[rows[k]] - state.time[rows[begin]] >= HORIZON_S) {
            stretches.push(begin..end + 1);
            begin = end;
        }
    }
    stretches
}

/// How far the position strays at each row of one rollout from the recorded state at the first, by the linearly implicit Euler method.
fn strays(state: &JointState, rows: &[usize], residual: &[f64], inertia: f64) -> Vec<f64> {
    let (mut stray, mut speed) = (0.0, 0.0);
    let mut strays = vec![0.0];
    let width = SLOPE_STEP_SHARE * state.sign_velocity;
    for (pair, torque) in rows.windows(2).zip(residual.windows(2)) {
        let step = (state.time[pair[1]] - state.time[pair[0]]) / EULER_STEPS as f64;
        for k in 0..EULER_STEPS {
            let share = (k as f64 + 0.5) / EULER_STEPS as f64;
            let between = |a: f64, b: f64| a + share * (b - a);
            let recorded = between(state.velocity[pair[0]], state.velocity[pair[1]]);
            let friction = |v: f64| state.base_friction_at(recorded + v);
            let force = between(torque[0], torque[1]) - (friction(speed) - friction(0.0));
            let slope = ((friction(speed + width) - friction(speed - width)) / (2.0 * width)).max(0.0);
            speed += step * force / (inertia + step * slope);
            stray += step * speed;
        }
        strays.push(stray);
    }
    strays
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnose::measurement::signals::Signals;

    /// A constant torque left over makes a joint without friction stray as `r t^2 / (2 J)`.
    #[test]
    fn a_constant_error_strays_quadratically() {
        let count = 2000;
        let signals = Signals {
            period: 1e-3,
            time: (0..count).map(|i| 1e-3 * f64::from(i)).collect(),
            position: (0..count).map(|i| (2e-3 * f64::from(i)).sin()).collect(),
            torque: vec![0.0; count as usize],
            segments: vec![0..count as usize],
            rotary: true,
            ..Signals::default()
        };
        let state = signals.states();
        let rows: Vec<usize> = (100..1900).step_by(5).collect();
        let runs = [0..rows.len()];
        let stretches = stretches(&state, &rows, &runs);
        let strayed: Vec<Vec<f64>> = stretches
            .iter()
            .map(|rows_of| strays(&state, &rows[rows_of.clone()], &vec![0.2; rows_of.len()], 0.5))
            .collect();
        assert_eq!(strayed.len(), 3);
        // Mean square of (a t^2 / 2) over the horizon: a^2 T^4 / 20.
        let expected = (0.4f64.powi(2) * HORIZON_S.powi(4) / 20.0).sqrt();
        let error = root_mean_square_of(&strayed[..1]);
        assert!((error / expected - 1.0).abs() < 0.03, "{error} {expected}");
    }
}
