//! Friction that remembers: presliding, lag, break-away after a rest.

use super::Bench;
use crate::second_opinion::motion::Trajectory;
use crate::second_opinion::numeric::peak;

/// Kind of presliding.
#[derive(Clone, Copy, Debug)]
pub enum Presliding {
    /// One element that approaches the level exponentially (Dahl, 1968).
    Dahl,
    /// Four elements that stick and slip (Iwan, 1966).
    FourElements,
}

/// Shares of the level and relative distances of the four elements.
const ELEMENTS: [[f64; 2]; 4] = [[0.35, 0.3], [0.3, 0.8], [0.2, 1.6], [0.15, 3.0]];
/// Substeps of a sample at least and at most.
const SUBSTEPS: [usize; 2] = [4, 60];
/// Greatest share of the distance that one substep may move.
const FINE: f64 = 0.05;

/// Coulomb friction builds up over a distance after each reversal.
pub(super) fn presliding(bench: &mut Bench, kind: Presliding, distance: f64) {
    let distance = bench.about(distance);
    let wanted = peak(&bench.path.velocity) * bench.grid.period_s / (FINE * distance);
    let substeps = (wanted.ceil() as usize).clamp(SUBSTEPS[0], SUBSTEPS[1]);
    let fine = bench.motion.at(&bench.grid.refined(substeps));
    let joint = bench.joint;
    let level: Vec<f64> = match kind {
        Presliding::Dahl => dahl(&fine.position, distance),
        Presliding::FourElements => four_elements(&fine.position, distance),
    };
    let sampled = level.iter().step_by(substeps);
    bench.friction = sampled.zip(&bench.path.velocity).map(|(z, v)| joint.coulomb * z + joint.viscous * v).collect();
    bench.note = format!("{kind:?}, distance {distance:.2e}");
}

/// State of one Dahl element over positions, from zero on, in units of its level.
pub fn dahl(position: &[f64], distance: f64) -> Vec<f64> {
    let (mut state, mut last) = (0.0, position[0]);
    let moved = |q: &f64| {
        let by = q - last;
        last = *q;
        if by != 0.0 {
            let target = by.signum();
            state = target + (state - target) * (-by.abs() / distance).exp();
        }
        state
    };
    position.iter().map(moved).collect()
}

fn four_elements(position: &[f64], distance: f64) -> Vec<f64> {
    let mut states = [0.0f64; 4];
    let mut last = position[0];
    let moved = |q: &f64| {
        let by = q - last;
        last = *q;
        let each = states.iter_mut().zip(ELEMENTS).map(|(state, [share, relative])| {
            *state = (*state + by / (relative * distance)).clamp(-1.0, 1.0);
            share * *state
        });
        each.sum()
    };
    position.iter().map(moved).collect()
}

/// Substeps of a time constant.
const STEPS_OF_A_LAG: f64 = 40.0;

/// Friction follows the velocity late, by a first-order lag or a delay.
pub(super) fn lag(bench: &mut Bench, time_constant_s: f64, pure_delay: bool) {
    let time_constant_s = bench.about(time_constant_s);
    let late = if pure_delay { delayed(bench, time_constant_s) } else { lagging(bench, time_constant_s) };
    let joint = bench.joint;
    bench.friction = late.iter().map(|v| joint.friction(*v)).collect();
    let kind = if pure_delay { "delay" } else { "lag" };
    bench.note = format!("{kind} of {:.0} ms", 1e3 * time_constant_s);
}

fn delayed(bench: &Bench, delay_s: f64) -> Vec<f64> {
    let samples = (delay_s / bench.grid.period_s).round() as usize;
    let velocity = &bench.path.velocity;
    (0..velocity.len()).map(|i| velocity[i.saturating_sub(samples)]).collect()
}

fn lagging(bench: &Bench, time_constant_s: f64) -> Vec<f64> {
    let substeps = (STEPS_OF_A_LAG * bench.grid.period_s / time_constant_s).ceil().max(1.0) as usize;
    let grid = bench.grid.refined(substeps);
    let Trajectory { velocity, .. } = bench.motion.at(&grid);
    let share = 1.0 - (-grid.period_s / time_constant_s).exp();
    let mut state = velocity[0];
    let follow = |v: &f64| {
        state += share * (v - state);
        state
    };
    let late: Vec<f64> = velocity.iter().map(follow).collect();
    late.into_iter().step_by(substeps).collect()
}

/// Speed below which the joint rests, rad/s or m/s.
const REST: f64 = 1e-9;
/// Rest from which on break-away grows, s.
const FIRST_S: f64 = 0.1;
/// Rest after which break-away is as large as stated, s.
const FULL_S: f64 = 2.0;

/// Break-away that grows with the logarithm of the rest and is gone after a distance.
pub(super) fn dwell_breakaway(bench: &mut Bench, torque: f64, distance: f64) {
    let torque = bench.torque(torque);
    // Distances of linear axes, in m, are smaller.
    let distance = bench.about(if bench.joint.linear { 0.1 * distance } else { distance });
    let (period_s, velocity) = (bench.grid.period_s, &bench.path.velocity);
    let (mut rested_s, mut moved, mut height) = (0.0f64, 0.0, 0.0);
    let extra = |v: &f64| {
        if v.abs() < REST {
            rested_s += period_s;
            moved = 0.0;
            height = torque * (rested_s / FIRST_S).ln_1p() / (FULL_S / FIRST_S).ln_1p();
            return 0.0;
        }
        rested_s = 0.0;
        moved += v.abs() * period_s;
        height * (-moved / distance).exp() * v.signum()
    };
    bench.extra = velocity.iter().map(extra).collect();
    bench.note = format!("break-away {torque:.3} after {FULL_S} s of rest, gone after {distance:.3}");
}
