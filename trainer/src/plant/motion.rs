//! Reference motions: position, velocity and acceleration at the sample instants, from rest at zero to rest at zero.
#![allow(non_snake_case, reason = "keys carry their unit, spelled as in the columns of a recording")]

use super::random::Draws;
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// The shapes of motion a trajectory can have. Ranges are maxima; the details are drawn from the seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
pub enum Motion {
    /// Sum of `lines` sinusoids with random phase.
    Multisine {
        /// Largest excursion, rad.
        amplitude_rad: f64,
        /// Lowest frequency, Hz.
        lowest_Hz: f64,
        /// Highest frequency, Hz.
        highest_Hz: f64,
        /// Largest speed, rad/s; the excursion shrinks where it would be exceeded.
        speed_rad_s: f64,
        /// Number of sinusoids (>= 1).
        lines: usize,
    },
    /// Constant speed back and forth with quick turns.
    Triangles {
        /// Excursion to both sides, rad.
        amplitude_rad: f64,
        /// Speed, rad/s.
        speed_rad_s: f64,
    },
    /// Trapezoidal moves to positions in turn, resting for a random one of `dwells_s`.
    Trapezoids {
        /// Excursion to both sides, rad.
        amplitude_rad: f64,
        /// Speed of the moves, rad/s.
        speed_rad_s: f64,
        /// Lengths of rest to draw from, s.
        dwells_s: Vec<f64>,
    },
    /// Short moves in one direction with rests of random length between, then the other way.
    StopAndGo {
        /// Length of one move, rad.
        step_rad: f64,
        /// Speed of the moves, rad/s.
        speed_rad_s: f64,
        /// Lengths of rest to draw from, s.
        dwells_s: Vec<f64>,
    },
    /// Slow reversals of amplitudes spread over `smallest_rad..largest_rad` about several positions.
    SmallReversals {
        /// Smallest amplitude, rad.
        smallest_rad: f64,
        /// Largest amplitude, rad.
        largest_rad: f64,
        /// Rate of the reversals, Hz.
        frequency_Hz: f64,
    },
    /// Logarithmic sine sweep with constant speed amplitude.
    Sweep {
        /// Amplitude at the lowest frequency, rad.
        amplitude_rad: f64,
        /// First frequency, Hz.
        lowest_Hz: f64,
        /// Last frequency, Hz.
        highest_Hz: f64,
    },
    /// Constant-velocity plateaus, each forth and back over the same positions.
    Plateaus {
        /// Speeds in turn, rad/s.
        speeds_rad_s: Vec<f64>,
        /// Time on each plateau in one direction, s.
        hold_s: f64,
    },
    /// One direction only, at a speed that swings about its mean, then the other direction.
    UnidirectionalSwing {
        /// Mean speed, rad/s.
        speed_rad_s: f64,
        /// Swing over the mean, [0, 1).
        swing: f64,
        /// Frequency of the swing, Hz.
        frequency_Hz: f64,
    },
    /// No motion.
    Rest,
}

/// A reference at the sample instants.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reference {
    /// Position, rad.
    pub position: Vec<f64>,
    /// Velocity, rad/s.
    pub velocity: Vec<f64>,
    /// Acceleration, rad/s2.
    pub acceleration: Vec<f64>,
}

/// Time over which a periodic motion fades in and out, s.
const FADE_S: f64 = 0.4;
/// Rest at both ends of a trajectory, s.
const REST_S: f64 = 0.1;
/// Length of the moving average that makes trapezoidal profiles finite in jerk, s.
const ROUNDING_S: f64 = 0.04;

impl Motion {
    /// Samples the motion: `duration_s` seconds at `rate_hz`.
    pub(crate) fn reference(&self, duration_s: f64, rate_hz: f64, draws: &mut Draws) -> Reference {
        let samples = (duration_s * rate_hz).round() as usize;
        match self {
            Self::Multisine { amplitude_rad, lowest_Hz, highest_Hz, speed_rad_s, lines } => {
                let tones = tones(*lowest_Hz, *highest_Hz, *lines, draws);
                multisine(&tones, *amplitude_rad, *speed_rad_s, duration_s, rate_hz)
            }
            Self::Sweep { amplitude_rad, lowest_Hz, highest_Hz } => {
                sweep(*amplitude_rad, *lowest_Hz, *highest_Hz, duration_s, rate_hz)
            }
            Self::SmallReversals { smallest_rad, largest_rad, frequency_Hz } => {
                let moves = small_reversals(*smallest_rad, *largest_rad, *frequency_Hz, duration_s, draws);
                follow(&moves, samples, rate_hz)
            }
            Self::UnidirectionalSwing { speed_rad_s, swing, frequency_Hz } => {
                unidirectional_swing(*speed_rad_s, *swing, *frequency_Hz, duration_s, rate_hz)
            }
            Self::Triangles { amplitude_rad, speed_rad_s } => {
                let moves = triangles(*amplitude_rad, *speed_rad_s, duration_s);
                follow(&moves, samples, rate_hz)
            }
            Self::Trapezoids { amplitude_rad, speed_rad_s, dwells_s } => {
                let moves = trapezoids(*amplitude_rad, *speed_rad_s, dwells_s, duration_s, draws);
                follow(&moves, samples, rate_hz)
            }
            Self::StopAndGo { step_rad, speed_rad_s, dwells_s } => {
                let moves = stop_and_go(*step_rad, *speed_rad_s, dwells_s, duration_s, draws);
                follow(&moves, samples, rate_hz)
            }
            Self::Plateaus { speeds_rad_s, hold_s } => {
                let moves = plateaus(speeds_rad_s, *hold_s, duration_s);
                follow(&moves, samples, rate_hz)
            }
            Self::Rest => Reference {
                position: vec![0.0; samples],
                velocity: vec![0.0; samples],
                acceleration: vec![0.0; samples],
            },
        }
    }
}

/// Speed of the way home at the end of a list of moves, rad/s.
const HOMING_RAD_S: f64 = 1.5;

/// A value with its first and second time derivative.
type Jet = (f64, f64, f64);

/// A smooth window, three times differentiable at its ends: rest, fade in, one, fade out, rest.
fn window(time: f64, duration: f64) -> Jet {
    let rise = |x: f64| -> Jet {
        if x <= 0.0 {
            (0.0, 0.0, 0.0)
        } else if x >= 1.0 {
            (1.0, 0.0, 0.0)
        } else {
            let x2 = x * x;
            let value = x2 * x2 * (35.0 - 84.0 * x + 70.0 * x2 - 20.0 * x2 * x);
            let slope = 140.0 * x2 * x * (1.0 - x).powi(3);
            let curvature = 420.0 * x2 * (1.0 - x).powi(2) * (1.0 - 2.0 * x);
            (value, slope / FADE_S, curvature / (FADE_S * FADE_S))
        }
    };
    if time < duration / 2.0 {
        rise((time - REST_S) / FADE_S)
    } else {
        let (value, slope, curvature) = rise((duration - REST_S - time) / FADE_S);
        (value, -slope, curvature)
    }
}

/// Samples `signal` under the window.
fn windowed(duration: f64, rate: f64, signal: impl Fn(f64) -> Jet) -> Reference {
    let samples = (duration * rate).round() as usize;
    let mut reference = Reference::default();
    for k in 0..samples {
        let time = k as f64 / rate;
        let (w, dw, ddw) = window(time, duration);
        let (p, v, a) = signal(time);
        reference.position.push(w * p);
        reference.velocity.push(dw * p + w * v);
        reference.acceleration.push(ddw * p + 2.0 * dw * v + w * a);
    }
    reference
}

/// Angular frequency, relative size and phase of every sinusoid; frequencies are spread evenly on a logarithmic axis.
fn tones(lowest: f64, highest: f64, lines: usize, draws: &mut Draws) -> Vec<(f64, f64, f64)> {
    (0..lines)
        .map(|i| {
            let place = (i as f64 + draws.between(0.2, 0.8)) / lines as f64;
            let frequency = lowest * (highest / lowest).powf(place);
            // Between equal speed and equal acceleration of all lines.
            (TAU * frequency, (lowest / frequency).powf(1.5), draws.between(0.0, TAU))
        })
        .collect()
}

fn multisine(tones: &[(f64, f64, f64)], amplitude: f64, speed: f64, duration: f64, rate: f64) -> Reference {
    let signal = |time: f64| {
        tones.iter().fold((0.0, 0.0, 0.0), |(p, v, a), &(omega, weight, phase)| {
            let (sine, cosine) = (omega * time + phase).sin_cos();
            (p + weight * sine, v + weight * omega * cosine, a - weight * omega * omega * sine)
        })
    };
    let mut reference = windowed(duration, rate, signal);
    let peak = |values: &[f64]| values.iter().fold(f64::MIN_POSITIVE, |peak, x| peak.max(x.abs()));
    let scale = (amplitude / peak(&reference.position)).min(speed / peak(&reference.velocity));
    for channel in [&mut reference.position, &mut reference.velocity, &mut reference.acceleration] {
        channel.iter_mut().for_each(|x| *x *= scale);
    }
    reference
}

fn sweep(amplitude: f64, lowest: f64, highest: f64, duration: f64, rate: f64) -> Reference {
    let growth = (highest / lowest).ln() / duration;
    windowed(duration, rate, |time| {
        let omega = TAU * lowest * (growth * time).exp();
        let phase = (omega - TAU * lowest) / growth;
        let size = amplitude * (-growth * time).exp();
        let (sine, cosine) = phase.sin_cos();
        let position = size * sine;
        let velocity = size * omega * cosine - growth * position;
        // size * omega is constant: d/dt (size * omega * cos) = -size * omega^2 * sin.
        (position, velocity, -size * omega * omega * sine - growth * velocity)
    })
}

fn unidirectional_swing(speed: f64, swing: f64, frequency: f64, duration: f64, rate: f64) -> Reference {
    // Forth for half of the time and back for the other half, with a slow smooth turn between.
    let samples = (duration * rate).round() as usize;
    let omega = TAU * frequency;
    let half = duration / 2.0;
    let speed_at = |time: f64| {
        let (local, sign) = if time < half { (time, 1.0) } else { (duration - time, -1.0) };
        let (rise, _, _) = window(local, half * 2.0);
        let (fall, _, _) = window(half - local + REST_S * 0.5, half * 2.0);
        sign * speed * rise * fall * (1.0 + swing * (omega * local).sin())
    };
    let mut reference = Reference::default();
    let (mut position, step) = (0.0, 1.0 / rate);
    for k in 0..samples {
        let time = k as f64 * step;
        reference.position.push(position);
        reference.velocity.push(speed_at(time));
        reference.acceleration.push((speed_at(time + step / 2.0) - speed_at(time - step / 2.0)) * rate);
        // Simpson's rule over one sample.
        position += step / 6.0 * (speed_at(time) + 4.0 * speed_at(time + step / 2.0) + speed_at(time + step));
    }
    reference
}

/// One trapezoidal move and the rest behind it.
struct Move {
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
fn follow(moves: &[Move], samples: usize, rate: f64) -> Reference {
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
        if raw.position.len() + ((needed * rate) as usize) + rest + average > samples {
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

fn triangles(amplitude: f64, speed: f64, duration: f64) -> Vec<Move> {
    let count = (duration * speed / amplitude) as usize + 2;
    (0..count).map(|i| Move::new(if i % 2 == 0 { amplitude } else { -amplitude }, speed, 0.0)).collect()
}

fn trapezoids(amplitude: f64, speed: f64, dwells: &[f64], duration: f64, draws: &mut Draws) -> Vec<Move> {
    let count = (duration * speed / amplitude) as usize + 2;
    (0..count)
        .map(|i| {
            let side = if i % 2 == 0 { 1.0 } else { -1.0 };
            let target = side * amplitude * draws.between(0.5, 1.0);
            Move::new(target, speed * draws.between(0.7, 1.0), draw_dwell(dwells, draws))
        })
        .collect()
}

fn stop_and_go(step: f64, speed: f64, dwells: &[f64], duration: f64, draws: &mut Draws) -> Vec<Move> {
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

fn small_reversals(smallest: f64, largest: f64, frequency: f64, duration: f64, draws: &mut Draws) -> Vec<Move> {
    let mut moves = Vec::new();
    let count = (duration * frequency).ceil() as usize + 1;
    let mut centre = draws.sign() * draws.between(0.1, 0.4);
    for i in 0..count {
        if i % 4 == 0 {
            centre = -centre.signum() * draws.between(0.1, 0.9);
            moves.push(Move::new(centre, 1.5, 0.05));
        }
        let amplitude = smallest * (largest / smallest).powf(draws.unit());
        let speed = (4.0 * amplitude * frequency).max(0.004);
        moves.push(Move { acceleration: speed * 20.0, ..Move::new(centre + amplitude, speed, 0.0) });
        moves.push(Move { acceleration: speed * 20.0, ..Move::new(centre - amplitude, speed, 0.0) });
    }
    moves
}

fn plateaus(speeds: &[f64], hold: f64, duration: f64) -> Vec<Move> {
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
