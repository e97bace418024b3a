//! Motions that are lists of trapezoidal moves: planning, sampling, and rounding of the corners.

use super::reference::{REST_S, Reference};
use crate::plant::random::Draws;

/// Length of the moving average that makes trapezoidal profiles finite in jerk, s.
const ROUNDING_S: f64 = 0.04;
/// Speed of the way home at the end of a list of moves, rad/s.
const HOMING_RAD_S: f64 = 1.5;

/// One trapezoidal move and the rest behind it.
pub(super) struct Move {
    target: f64,
    speed: f64,
    acceleration: f64,
    dwell: f64,
}

impl Move {
    fn new(target: f64, speed: f64, dwell: f64) -> Self {
        // Top speed after a tenth of a second, and never a violent start.
        Self { target, speed, acceleration: (speed / 0.1).clamp(2.0, 25.0), dwell }
    }

    fn duration_from(&self, start: f64) -> f64 {
        let distance = (self.target - start).abs();
        let ramp = (self.speed / self.acceleration).min((distance / self.acceleration).sqrt());
        if ramp == 0.0 {
            return self.dwell;
        }
        2.0 * ramp + (distance - self.acceleration * ramp * ramp).max(0.0) / (self.acceleration * ramp) + self.dwell
    }
}

/// Samples a list of moves, goes home in time, and rounds the corners.
pub(super) fn follow(moves: &[Move], samples: usize, rate: f64) -> Reference {
    let step = 1.0 / rate;
    let average = ((ROUNDING_S * rate) as usize).max(1);
    let rest = (REST_S * rate) as usize;
    let mut raw = Reference::default();
    let hold = |raw: &mut Reference, position: f64, count: usize| {
        raw.position.extend(std::iter::repeat_n(position, count));
        raw.velocity.extend(std::iter::repeat_n(0.0, count));
        raw.acceleration.extend(std::iter::repeat_n(0.0, count));
    };
    hold(&mut raw, 0.0, rest);
    let mut position = 0.0;
    for next in moves {
        let home = Move::new(0.0, HOMING_RAD_S, 0.0);
        let needed = next.duration_from(position) + home.duration_from(next.target);
        if ((needed * rate) as usize).saturating_add(raw.position.len() + rest + average) > samples {
            break;
        }
        travel(&mut raw, position, next, step);
        position = next.target;
        hold(&mut raw, position, (next.dwell * rate) as usize);
    }
    travel(&mut raw, position, &Move::new(0.0, HOMING_RAD_S, 0.0), step);
    let left = samples.saturating_sub(raw.position.len());
    hold(&mut raw, 0.0, left);
    Reference {
        position: moving_average(&raw.position, average, samples),
        velocity: moving_average(&raw.velocity, average, samples),
        acceleration: moving_average(&raw.acceleration, average, samples),
    }
}

fn travel(raw: &mut Reference, start: f64, next: &Move, step: f64) {
    let (distance, sign) = ((next.target - start).abs(), (next.target - start).signum());
    if distance < 1e-12 {
        return;
    }
    let ramp = (next.speed / next.acceleration).min((distance / next.acceleration).sqrt());
    let top = next.acceleration * ramp;
    let cruise = ((distance - top * ramp) / top).max(0.0);
    let total = 2.0 * ramp + cruise;
    for k in 0..(total / step).ceil() as usize {
        let time = k as f64 * step;
        let (p, v, a) = if time < ramp {
            (0.5 * next.acceleration * time * time, next.acceleration * time, next.acceleration)
        } else if time < ramp + cruise {
            (top * (time - 0.5 * ramp), top, 0.0)
        } else {
            let left = total - time;
            (distance - 0.5 * next.acceleration * left * left, next.acceleration * left, -next.acceleration)
        };
        raw.position.push(start + sign * p);
        raw.velocity.push(sign * v);
        raw.acceleration.push(sign * a);
    }
}

/// Causal moving average of the first `samples` values; the signal is taken as constant before its start.
fn moving_average(signal: &[f64], length: usize, samples: usize) -> Vec<f64> {
    let mut sum = signal.first().copied().unwrap_or(0.0) * length as f64;
    (0..samples)
        .map(|k| {
            let newest = signal.get(k).or(signal.last()).copied().unwrap_or(0.0);
            let oldest = signal[k.saturating_sub(length).min(signal.len() - 1)];
            sum += newest - oldest;
            sum / length as f64
        })
        .collect()
}

pub(super) fn triangles(amplitude: f64, speed: f64, duration: f64) -> Vec<Move> {
    let count = (duration * speed / amplitude) as usize + 2;
    (0..count).map(|i| Move::new(if i % 2 == 0 { amplitude } else { -amplitude }, speed, 0.0)).collect()
}

pub(super) fn trapezoids(amplitude: f64, speed: f64, dwells: &[f64], duration: f64, draws: &mut Draws) -> Vec<Move> {
    let count = (duration * speed / amplitude) as usize + 2;
    (0..count)
        .map(|i| {
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            let target = side * amplitude * draws.between(0.5, 1.0);
            Move::new(target, speed * draws.between(0.7, 1.0), draw_dwell(dwells, draws))
        })
        .collect()
}

pub(super) fn stop_and_go(step: f64, speed: f64, dwells: &[f64], duration: f64, draws: &mut Draws) -> Vec<Move> {
    let mut target = 0.0;
    let mut moves = Vec::new();
    let mut time = 0.0;
    while time < duration && moves.len() < 10_000 {
        let direction = if time < 0.45 * duration { 1.0 } else { -1.0 };
        let dwell = draw_dwell(dwells, draws);
        let next = Move::new(target + direction * step * draws.between(0.7, 1.3), speed, dwell);
        time += next.duration_from(target).max(0.01);
        target = next.target;
        moves.push(next);
    }
    moves
}

pub(super) fn small_reversals(
    smallest: f64,
    largest: f64,
    frequency: f64,
    duration: f64,
    draws: &mut Draws,
) -> Vec<Move> {
    let mut moves = Vec::new();
    let count = (duration * frequency).ceil() as usize + 1;
    let mut centre = draws.sign() * draws.between(0.1, 0.4);
    for i in 0..count {
        if i % 4 == 0 {
            centre = -centre.signum() * draws.between(0.1, 1.2);
            moves.push(Move::new(centre, 1.5, 0.05));
        }
        let amplitude = smallest * (largest / smallest).powf(draws.unit());
        let speed = (4.0 * amplitude * frequency).max(0.004);
        moves.push(Move { acceleration: speed * 20.0, ..Move::new(centre + amplitude, speed, 0.0) });
        moves.push(Move { acceleration: speed * 20.0, ..Move::new(centre - amplitude, speed, 0.0) });
    }
    moves
}

pub(super) fn plateaus(speeds: &[f64], hold: f64, duration: f64) -> Vec<Move> {
    let mut moves = Vec::new();
    let mut time = 0.0;
    for &speed in speeds.iter().cycle().take(1000) {
        if speed <= 0.0 || time > duration {
            break;
        }
        moves.push(Move::new(0.5 * speed * hold, speed, 0.0));
        moves.push(Move::new(-0.5 * speed * hold, speed, 0.0));
        time += 2.0 * hold;
    }
    moves
}

fn draw_dwell(dwells: &[f64], draws: &mut Draws) -> f64 {
    if dwells.is_empty() { 0.0 } else { dwells[draws.index(dwells.len())] * draws.between(0.8, 1.25) }
}
