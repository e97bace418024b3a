//! What changes over the recording: temperature, warming up, drift.

use super::Bench;
use crate::second_opinion::numeric::range;

/// Course of a temperature.
#[derive(Clone, Copy, Debug)]
pub enum Profile {
    /// Warms up, cools down, warms up.
    WarmRestWarm,
    /// Warms up.
    Rise,
    /// A sine and a half.
    Sine,
    /// Cools down with a wave on it.
    Fall,
}

impl Profile {
    /// degC at a share of the recording.
    fn at(self, x: f64) -> f64 {
        let risen = |x: f64, constant: f64| 1.0 - (-x / constant).exp();
        match self {
            Self::WarmRestWarm => {
                let top = 18.0 * risen(0.4, 0.15);
                25.0 + if x < 0.4 {
                    18.0 * risen(x, 0.15)
                } else if x < 0.65 {
                    top * (-(x - 0.4) / 0.12).exp()
                } else {
                    top * (-0.25f64 / 0.12).exp() + 16.0 * risen(x - 0.65, 0.15)
                }
            }
            Self::Rise => 22.0 + 20.0 * risen(x, 0.4),
            Self::Sine => 30.0 + 10.0 * (3.0 * std::f64::consts::PI * x).sin(),
            Self::Fall => 45.0 - 15.0 * risen(x, 0.5) + 4.0 * (9.0 * x).sin(),
        }
    }
}

/// Noise of a recorded temperature, K.
const TEMPERATURE_NOISE_K: f64 = 0.05;

/// Coulomb friction changes linearly with temperature, viscous friction exponentially; shares a kelvin.
pub(super) fn temperature(bench: &mut Bench, profile: Profile, coulomb: f64, viscous: f64, step_k: f64) {
    let (coulomb, viscous) = (bench.about(coulomb), bench.about(viscous));
    let duration_s = bench.grid.duration_s();
    let course: Vec<f64> = bench.path.time.iter().map(|t| profile.at(t / duration_s)).collect();
    let mean = course.iter().sum::<f64>() / course.len() as f64;
    let joint = bench.joint;
    let friction = |(v, temperature): (&f64, &f64)| {
        let warmer = temperature - mean;
        joint.coulomb * (1.0 + coulomb * warmer) * joint.sign(*v) + joint.viscous * (-viscous * warmer).exp() * v
    };
    bench.friction = bench.path.velocity.iter().zip(&course).map(friction).collect();
    let (low, high) = range(&course);
    bench.note = format!(
        "Coulomb {:+.2} %/K, viscous {:+.2} %/K over {:.0} K, {profile:?}",
        100.0 * coulomb,
        -100.0 * viscous,
        high - low
    );
    let read =
        |temperature: &f64| ((temperature + TEMPERATURE_NOISE_K * bench.random.normal()) / step_k).round() * step_k;
    bench.columns.push(("temperature_C", course.iter().map(read).collect()));
}

/// Coulomb and viscous friction change with the power that friction has turned into heat, by these shares at the hottest.
pub(super) fn warm_up(bench: &mut Bench, time_constant_s: f64, coulomb: f64, viscous: f64) {
    let time_constant_s = bench.about(time_constant_s);
    let (coulomb, viscous) = (bench.about(coulomb), bench.about(viscous));
    let share = 1.0 - (-bench.grid.period_s / time_constant_s).exp();
    let velocity = &bench.path.velocity;
    let mut heat = 0.0;
    let warmed = (0..velocity.len()).map(|i| {
        heat += share * ((bench.friction[i] * velocity[i]).abs() - heat);
        heat
    });
    let heat: Vec<f64> = warmed.collect();
    let hottest = range(&heat).1;
    let joint = bench.joint;
    let friction = |(v, heat): (&f64, &f64)| {
        let warm = heat / hottest;
        joint.coulomb * (1.0 + coulomb * warm) * joint.sign(*v) + joint.viscous * (1.0 + viscous * warm) * v
    };
    bench.friction = velocity.iter().zip(&heat).map(friction).collect();
    bench.note = format!(
        "Coulomb {:+.0} %, viscous {:+.0} % when warm, time constant {time_constant_s:.0} s",
        100.0 * coulomb,
        100.0 * viscous
    );
}

/// Coulomb friction changes evenly over the recording.
pub(super) fn slow_drift(bench: &mut Bench, torque: f64) {
    let torque = bench.torque(torque);
    let (joint, duration_s) = (bench.joint, bench.grid.duration_s());
    bench.add(|t, _, v, _| torque * (2.0 * t / duration_s - 1.0) * joint.sign(v));
    bench.note = format!("Coulomb friction drifts by {:.3}", 2.0 * torque);
}
