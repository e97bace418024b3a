//! Structures that the catalogue does not name.

use super::PROTOCOLS;
use crate::second_opinion::motion::Trajectory;
use crate::second_opinion::numeric::peak;
use crate::second_opinion::protocol::Protocol;
use crate::second_opinion::random::{Random, factor, phase};
use crate::second_opinion::recording::Material;
use crate::second_opinion::{Case, Part};
use std::f64::consts::TAU;

/// Which protocols record them.
const RECORDED_BY: [usize; 10] = [0, 1, 3, 4, 2, 5, 6, 7, 0, 4];
/// Noise of the velocity as a share of the top speed.
const VELOCITY_NOISE: f64 = 1e-4;

pub(super) fn cases() -> Vec<Case> {
    let case = |index: usize| {
        let make = move |random: &mut _| record(index, &PROTOCOLS[RECORDED_BY[index]], random);
        Case::new(format!("unnamed-{}", index + 1), Part::Unnamed, vec!["unknown"], make)
    };
    (0..RECORDED_BY.len()).map(case).collect()
}

fn record(index: usize, protocol: &Protocol, random: &mut Random) -> Material {
    let fine = protocol.fine(random);
    let (joint, path) = (&fine.joint, fine.sampled());
    let (one, two) = (wandering(&path, 0.037, random), wandering(&path, 0.061, random));
    let size = joint.coulomb * factor(random);
    let (top, reach) = (joint.top_speed, peak(&path.position));
    let sign = |v: f64| joint.sign(v);
    let mut channels: Vec<(&str, Vec<f64>)> = Vec::new();
    let scaled = |values: &[f64], by: f64| values.iter().map(|value| by * value).collect::<Vec<f64>>();
    let by_row = |torque: &dyn Fn(usize) -> f64| (0..path.len()).map(torque).collect::<Vec<f64>>();
    let v = &path.velocity;
    let (torque, note) = match index {
        0 => {
            channels = vec![("oil_level_mm", scaled(&one, 10.0)), ("humidity_pct", scaled(&two, 100.0))];
            (by_row(&|i| 0.8 * size * one[i] * two[i] * sign(v[i])), "friction grows with oil level times humidity")
        }
        1 => {
            let torque = path.map(|_, q, v, _| 0.5 * size * (4.0 * q / reach * v / top).tanh());
            (torque, "tanh of position times velocity")
        }
        2 => {
            channels = vec![("pressure_bar", one.clone())];
            (by_row(&|i| 6.0 * size * (one[i] - 0.5).powi(2)), "torque of the square of a pressure")
        }
        3 => {
            channels = vec![("supply_bar", one.clone())];
            (by_row(&|i| 0.5 * size * (9.0 * (one[i] - 0.6)).tanh()), "torque of a valve that opens with the supply")
        }
        4 | 7 => {
            let fresh = since_fast(&path, 0.7 * top);
            (by_row(&|i| 0.6 * size * (-fresh[i] / 1.5).exp() * sign(v[i])), "friction for a while after fast motion")
        }
        5 => {
            let state = path.map(|t, _, _, _| f64::from((0.21 * t) % 1.0 > 0.55));
            let torque = by_row(&|i| 0.4 * size * state[i] * sign(v[i]));
            channels = vec![("brake_state", state)];
            (torque, "friction while a brake is on")
        }
        6 => {
            let torque = path.map(|_, q, v, _| 0.4 * size * (4.0 * q / reach).sin() * (4.7 * v / top).sin());
            (torque, "waves over position times waves over velocity")
        }
        8 => {
            let phase = phase(random);
            (path.map(|t, _, _, _| 0.3 * size * (TAU * 0.77 * t + phase).sin()), "a hum of 0.77 Hz in time")
        }
        _ => {
            let torque = path.map(|_, q, v, _| 0.5 * size * (v / top).powi(2) * q.signum() * (q / reach).abs().sqrt());
            (torque, "square of the velocity times a root of the position")
        }
    };
    let mut sum = Protocol::torque(joint, &path);
    sum.iter_mut().zip(&torque).for_each(|(sum, torque)| *sum += torque);
    protocol.disturb(&mut sum, random);
    let mut real = Protocol::columns(joint, &path, sum, VELOCITY_NOISE, random);
    for (name, values) in channels {
        real.put(name, values);
    }
    protocol.of(joint, real, &format!("{note}, size {size:.3}"))
}

/// A channel that wanders between 0 and 1.
fn wandering(path: &Trajectory, hz: f64, random: &mut Random) -> Vec<f64> {
    let (slow, fast) = (phase(random), phase(random));
    path.map(|t, _, _, _| 0.5 + 0.28 * (TAU * hz * t + slow).sin() + 0.2 * (TAU * 2.7 * hz * t + fast).sin())
}

/// Time since the speed was last above a bound, s; long at first.
fn since_fast(path: &Trajectory, bound: f64) -> Vec<f64> {
    let period_s = path.time[1] - path.time[0];
    let mut since = 9.0;
    let count = |v: &f64| {
        since = if v.abs() > bound { 0.0 } else { since + period_s };
        since
    };
    path.velocity.iter().map(count).collect()
}
