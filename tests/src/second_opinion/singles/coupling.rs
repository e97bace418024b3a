//! Torques that the motion of another joint brings.

use super::Bench;
use crate::second_opinion::numeric::peak;
use crate::second_opinion::random::phase;
use std::f64::consts::TAU;

/// What of the other joint acts, and how it is recorded.
#[derive(Clone, Copy, Debug)]
pub enum Partner {
    /// Its acceleration, in a column of this name.
    Acceleration(&'static str),
    /// Its acceleration, beside position and velocity.
    AccelerationOfThree,
    /// All of a planar arm of two links.
    Arm,
    /// The square of its velocity.
    Velocity,
    /// Its acceleration, of which only the position is recorded.
    Position,
}

/// Frequencies of the other joint in short and in long recordings, Hz.
const HZ: [[f64; 3]; 2] = [[0.37, 0.83, 1.9], [0.11, 0.37, 0.83]];
/// A recording that is long, s.
const LONG_S: f64 = 40.0;
/// Amplitudes, rad.
const AMPLITUDES_RAD: [f64; 3] = [0.8, 0.48, 0.2];

/// A torque of this greatest size.
pub(super) fn coupling(bench: &mut Bench, torque: f64, partner: Partner) {
    let torque = bench.torque(torque);
    let hz = HZ[usize::from(bench.grid.duration_s() >= LONG_S)];
    let lines: Vec<[f64; 3]> = (0..3).map(|k| [TAU * hz[k], AMPLITUDES_RAD[k], phase(bench.random)]).collect();
    let derivative = |order: i32| -> Vec<f64> {
        let turn = f64::from(order) * TAU / 4.0;
        let at =
            |t: &f64| lines.iter().map(|[w, size, phase]| size * w.powi(order) * (w * t + phase + turn).sin()).sum();
        bench.path.time.iter().map(at).collect()
    };
    let (q2, v2, a2) = (derivative(0), derivative(1), derivative(2));
    let of_arm = |i: usize| {
        let (sine, cosine) = q2[i].sin_cos();
        let v = bench.path.velocity[i];
        (1.0 + 0.6 * cosine) * a2[i] - 0.3 * sine * v2[i] * v2[i] - 0.6 * sine * v * v2[i]
    };
    let shape: Vec<f64> = match partner {
        Partner::Acceleration(_) | Partner::AccelerationOfThree | Partner::Position => a2.clone(),
        Partner::Arm => (0..a2.len()).map(of_arm).collect(),
        Partner::Velocity => v2.iter().map(|v| v * v).collect(),
    };
    let largest = peak(&shape);
    bench.extra = shape.iter().map(|value| torque * value / largest).collect();
    bench.columns.extend(match partner {
        Partner::Acceleration(name) => vec![(name, a2)],
        Partner::AccelerationOfThree => vec![("q2", q2), ("dq2", v2), ("ddq2", a2)],
        Partner::Arm => {
            vec![("joint2_position_rad", q2), ("joint2_velocity_rad_s", v2), ("joint2_acceleration_rad_s2", a2)]
        }
        Partner::Velocity => vec![("joint2_velocity_rad_s", v2)],
        Partner::Position => vec![("joint2_position_rad", q2)],
    });
    bench.note = format!("{torque:.3} at most from another joint, {partner:?}");
}
